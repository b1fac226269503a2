// JSON from untrusted files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fcl_stpbv::detail {

/// Parses a text; `name` stands for it in messages. A text that is not JSON is refused, and so is an object
/// with the same key twice.
/// @throws Error naming the file.
nlohmann::json parseJson(const std::string& text, const std::string& name);

/// Reads and parses a file of up to 64 MB. @throws Error naming the file.
nlohmann::json readJson(const std::string& path);

}  // namespace fcl_stpbv::detail
