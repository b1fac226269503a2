// JSON from untrusted files: at most 64 MB, and a key given twice is refused.
#include "fcl_stpbv/mesh/json_text.h"

#include <set>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::detail {

nlohmann::json parseJson(const std::string& text, const std::string& name) {
  using nlohmann::json;
  std::vector<std::set<std::string>> keys;  // keys of the objects that are open
  const auto checkKeys = [&](int, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      throw Error(name + ": has the key '" + parsed.get<std::string>() + "' twice; remove one");
    return true;
  };
  try {
    return json::parse(text, checkKeys);
  } catch (const json::exception& error) {
    throw Error(name + ": is no JSON (" + error.what() + ")");
  }
}

nlohmann::json readJson(const std::string& path) {
  constexpr std::size_t kMostJson = 64u << 20;
  return parseJson(readText(path, kMostJson), path);
}

}  // namespace fcl_stpbv::detail
