// See shown_text.h.
#include "fcl_stpbv/report/shown_text.h"

#include <algorithm>

namespace fcl_stpbv::report {

std::string withoutFolders(std::string text, const std::string& file) {
  if (const std::size_t name = file.rfind('/') + 1; name > 0)
    for (std::size_t found = 0; (found = text.find(file, found)) != std::string::npos;)
      text.erase(found, name);
  constexpr const char *kBefore = " '\"([", *kAfter = " '\",:;)]\n";
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const bool begins =
        text[i] == '/' && (i == 0 || std::string(kBefore).find(text[i - 1]) != std::string::npos);
    const std::size_t end = begins ? std::min(text.find_first_of(kAfter, i), text.size()) : i + 1;
    const std::size_t last = text.rfind('/', end - 1);
    const std::size_t from = begins && last > i && last + 1 < end ? last + 1 : i;
    out += text.substr(from, end - from);
    i = end;
  }
  return out;
}

}  // namespace fcl_stpbv::report
