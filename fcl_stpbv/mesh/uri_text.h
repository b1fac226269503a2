// Interprets file names and URIs: percent encoding such as %20, and the backslashes of Windows.
#pragma once

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <vector>

namespace fcl_stpbv::detail {

/// The text with each %XX replaced by its byte. The text is unchanged if one of them gives a byte that is not
/// allowed in a name.
inline std::string percentDecoded(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    const std::string digits = text.substr(i + 1, 2);
    const bool hex = digits.size() == 2 && std::all_of(digits.begin(), digits.end(),
                                                       [](unsigned char c) { return std::isxdigit(c); });
    if (!hex || digits == "00") return text;
    decoded += static_cast<char>(std::stoi(digits, nullptr, 16));
    i += 2;
  }
  return decoded;
}

/// The path in a name with file://. It is absolute after the host name "localhost" too. No value for other
/// names.
inline std::optional<std::string> filePathIn(const std::string& uri) {
  const std::string start = "file://", host = "localhost/";
  if (uri.compare(0, start.size(), start) != 0) return std::nullopt;
  const bool hasHost = uri.compare(start.size(), host.size(), host) == 0;
  return uri.substr(start.size() + (hasHost ? host.size() - 1 : 0));
}

/// The names that a uri in a glTF may mean, in the order in which they are tried.
inline std::vector<std::string> namesOf(const std::string& uri) {
  std::string slashes = uri;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  return {uri, percentDecoded(uri), slashes, percentDecoded(slashes)};
}

}  // namespace fcl_stpbv::detail
