// The manifest names every file of the folder with its SHA-256.
#include "fcl_stpbv/report/kept_folder.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/report/digest.h"

namespace fcl_stpbv::report {
namespace {

namespace fs = std::filesystem;

// The manifest of a conversion. Error if the folder has none, because then it is not the output of a
// conversion.
nlohmann::json manifestOf(const fs::path& folder) {
  const fs::path path = folder / kManifest;
  std::error_code ignored;
  if (!fs::is_regular_file(fs::symlink_status(path, ignored)))
    throw Error(folder.string() + ": holds files that no conversion wrote; name a new or an empty folder");
  const nlohmann::json manifest = nlohmann::json::parse(detail::readText(path.string()), nullptr, false);
  const bool ours = manifest.is_object() && manifest.value("program", nlohmann::json()) == "urdf_to_stpbv" &&
                    manifest.value("key", nlohmann::json()).is_string() &&
                    manifest.value("files", nlohmann::json()).is_object();
  if (!ours) throw Error(path.string() + ": is no manifest of a conversion; name a new or an empty folder");
  return manifest;
}

// Whether `path` is in the folder or in a folder below it.
bool isIn(const fs::path& folder, const std::string& path) {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(path, ignored), around = fs::weakly_canonical(folder, ignored);
  return std::mismatch(around.begin(), around.end(), real.begin(), real.end()).first == around.end();
}

}  // namespace

std::string keyOfFolder(const std::string& path, const std::vector<std::string>& inputs, bool force) {
  if (path.empty()) throw Error("-o: expected the name of a folder");
  if (path == "-")
    throw Error("-o -: expected the name of a folder, since a robot is many files; ./- is one");
  std::error_code ignored;
  const fs::path name = (fs::path(path) / "").parent_path();  // without a slash at the end
  const fs::path parent = name.parent_path().empty() ? "." : name.parent_path();
  if (!fs::is_directory(parent, ignored))
    throw Error("-o " + path + ": " +
                (fs::exists(parent, ignored)
                     ? parent.string() + " is a file, expected a folder"
                     : "the folder " + parent.string() + " does not exist; make it first"));
  const bool isNew = !fs::exists(fs::symlink_status(name, ignored));
  if (!isNew && !fs::is_directory(name, ignored))
    throw Error("-o " + path +
                (fs::exists(name, ignored) ? ": is a file, expected a folder"
                                           : ": is a link that leads nowhere; remove it or name a folder"));
  for (const std::string& input : inputs)
    if (isIn(name, input))
      throw Error("-o " + path + ": " + input + " lies in it and is read; name another folder");
  if (isNew || fs::is_empty(name, ignored)) return "";
  const nlohmann::json manifest = manifestOf(name);
  std::size_t found = 0;
  bool same = true;
  for (const auto& entry : fs::recursive_directory_iterator(name)) {
    if (entry.is_directory() && !entry.is_symlink()) continue;
    const std::string file = fs::relative(entry.path(), name).string();
    if (file == kManifest) continue;
    const auto known = manifest["files"].find(file);
    if (known == manifest["files"].end() || entry.is_symlink())
      throw Error(entry.path().string() +
                  ": no conversion wrote it, and it would be lost; move it away or name another folder");
    ++found;
    if (*known == sha256(detail::readText(entry.path().string()))) continue;
    same = false;
    if (!force)
      throw Error(entry.path().string() +
                  ": was changed since it was written; give --force to replace it, or name another folder");
  }
  return same && found == manifest["files"].size() ? manifest["key"].get<std::string>() : "";
}

std::vector<std::string> warningsOfFolder(const std::string& folder) {
  std::vector<std::string> warnings;
  const nlohmann::json manifest = manifestOf(folder);
  for (const nlohmann::json& warning : manifest.value("warnings", nlohmann::json::array()))
    if (warning.is_string()) warnings.push_back(warning.get<std::string>());
  return warnings;
}

void addFiles(nlohmann::ordered_json& manifest, const std::string& key, const detail::FolderFiles& files) {
  manifest["key"] = key;
  for (const auto& [name, content] : files) manifest["files"][name] = sha256(content);
}

}  // namespace fcl_stpbv::report
