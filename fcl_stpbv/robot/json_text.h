// JSON from untrusted files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fcl_stpbv::detail {

/// Parses a text; `name` stands for it in messages. Refused: what is no JSON,
/// and an object that has a key twice.
/// @throws Error naming the file.
nlohmann::json parseJson(const std::string& text, const std::string& name);

/// Reads and parses a file of up to 64 MB. @throws Error naming the file.
nlohmann::json readJson(const std::string& path);

}  // namespace fcl_stpbv::detail
