// Finds the files of package://, file:// and relative names, in the order that package_path.h lists.
#include "fcl_stpbv/robot/package_path.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/uri_text.h"
#include "fcl_stpbv/mesh/xml_text.h"

namespace fcl_stpbv::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackage = "package://";

bool startsWith(const std::string& text, std::string_view start) {
  return text.compare(0, start.size(), start) == 0;
}

std::vector<std::string> splitAtColons(const char* list) {
  std::vector<std::string> parts;
  for (std::string rest = list ? list : ""; !rest.empty();) {
    const std::size_t colon = rest.find(':');
    if (colon != 0) parts.push_back(rest.substr(0, colon));
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return parts;
}

// The name in a folder's package.xml, or "" if there is none.
std::string packageIn(const fs::path& folder) {
  std::error_code ignored;
  const fs::path file = folder / "package.xml";
  if (!fs::is_regular_file(file, ignored)) return "";
  try {
    tinyxml2::XMLDocument document;
    loadXml(file.string(), document);
    const tinyxml2::XMLElement* name = document.RootElement()->FirstChildElement("name");
    return name && name->GetText() ? name->GetText() : "";
  } catch (const Error&) {
    return "";  // the folder is no package; its path is listed among those tried
  }
}

// The scheme of a name if it is one that is not supported, such as "http:/"; else "".
std::string otherKind(const std::string& uri) {
  const std::size_t colon = uri.find(":/");
  if (colon == std::string::npos || colon < 2 || startsWith(uri, kPackage) || filePathIn(uri)) return "";
  const bool word =
      std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                  [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
  return word ? uri.substr(0, colon + 2) : "";
}

bool isPackage(const fs::path& folder, const std::string& name) {
  const fs::path plain = folder.has_filename() ? folder : folder.parent_path();
  return plain.filename() == name || packageIn(folder) == name;
}

// The package of a name and the path in it, whatever the number of slashes between them.
std::pair<std::string, std::string> partsOf(const std::string& uri) {
  const std::string inside = uri.substr(kPackage.size());
  const std::size_t slash = inside.find('/');
  const std::size_t start = std::min(inside.find_first_not_of('/', slash), inside.size());
  return {inside.substr(0, slash), fs::path(inside.substr(start)).lexically_normal().string()};
}

// The packages of a name below a folder, by rospack's rules: at any depth, but not inside another package,
// and not in hidden folders or folders marked to be ignored. Each folder is visited once; `seen` lists the
// visited ones.
void findBelow(const fs::path& folder, const std::string& package, std::set<fs::path>& seen,
               std::vector<std::string>& found) {
  constexpr std::size_t kMost = 100000;  // limit in case somebody names a whole disk
  std::error_code end, ignored;
  if (seen.size() == kMost || !seen.insert(fs::canonical(folder, ignored)).second) return;
  if (fs::exists(folder / "package.xml", ignored)) {
    if (packageIn(folder) == package) found.push_back(folder.string());
    return;
  }
  std::set<fs::path> inner;  // sorted, so that the order is the same everywhere
  fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, end);
  for (; !end && entry != fs::directory_iterator(); entry.increment(end))
    if (entry->is_directory(ignored) && entry->path().filename().string()[0] != '.')
      inner.insert(entry->path());
  for (const fs::path& next : inner)
    if (!fs::exists(next / "CATKIN_IGNORE", ignored)) findBelow(next, package, seen, found);
}

}  // namespace

PackagePath::PackagePath(const std::string& urdf, std::vector<std::string> folders)
    : folders_(std::move(folders)),
      rosFolders_(splitAtColons(std::getenv("ROS_PACKAGE_PATH"))),
      prefixes_(splitAtColons(std::getenv("AMENT_PREFIX_PATH"))) {
  folders_.insert(folders_.end(), rosFolders_.begin(), rosFolders_.end());
  std::error_code error;
  // A URDF from a pipe has no folder; its relative names are relative to the working folder.
  const bool pipe = fs::exists(urdf, error) && !fs::is_regular_file(urdf, error);
  const fs::path named = fs::absolute(pipe ? "-" : urdf, error).lexically_normal();
  std::vector<fs::path> places = {named};
  if (const fs::path real = fs::canonical(named, error); !error && real != named) places.push_back(real);
  for (const fs::path& place : places) {
    fs::path folder = place.parent_path();
    urdfFolders_.push_back(folder.string());
    for (; !folder.empty(); folder = folder.parent_path()) {
      above_.push_back(folder.string());
      if (folder == folder.root_path()) break;
    }
  }
}

std::vector<std::string> PackagePath::candidates(const std::string& uri) const {
  std::vector<std::string> paths;
  const auto add = [&](const fs::path& path) {
    const std::string text = path.lexically_normal().string();
    if (std::find(paths.begin(), paths.end(), text) == paths.end()) paths.push_back(text);
  };
  if (!startsWith(uri, kPackage)) {
    for (const std::string& folder : urdfFolders_)
      add(fs::path(folder) / filePathIn(uri).value_or(uri));  // an absolute path stays as it is
  } else {
    const auto [package, rest] = partsOf(uri);
    for (const std::string& folder : folders_) {
      if (isPackage(folder, package)) add(fs::path(folder) / rest);
      add(fs::path(folder) / package / rest);
    }
    for (const std::string& prefix : prefixes_) add(fs::path(prefix) / "share" / package / rest);
    for (const std::string& folder : above_) {
      if (isPackage(folder, package)) add(fs::path(folder) / rest);
      if (!packageIn(folder).empty()) add(fs::path(folder).parent_path() / package / rest);
    }
    // A package inside another one, as in a partial checkout: only its own folder name is used.
    for (const std::string& folder : folders_)
      for (std::size_t next = rest.find('/');
           next != std::string::npos && rest.find('/', next + 1) != std::string::npos;
           next = rest.find('/', next + 1))
        add(fs::path(folder) / rest.substr(next + 1));
    // In a downloaded folder the packages are often beside each other, without a package.xml.
    constexpr int kNear = 3;  // the URDF's folder, its package, and the folder that contains the package
    for (const std::string& place : urdfFolders_) {
      fs::path folder = place;
      for (int up = 0; up < kNear; ++up, folder = folder.parent_path()) add(folder / package / rest);
    }
  }
  return paths;
}

const std::vector<std::string>& PackagePath::deeper(const std::string& package) const {
  const auto [places, isNew] = deeper_.try_emplace(package);
  std::set<fs::path> seen;
  for (const std::string& folder : rosFolders_)
    if (isNew) findBelow(folder, package, seen, places->second);
  return places->second;
}

std::string PackagePath::resolve(const std::string& uri) const {
  if (const std::string kind = otherKind(uri); !kind.empty())
    throw Error(uri + ": names that begin with '" + kind +
                "' are not read; give one with package:// or file://, or a path");
  std::vector<std::string> paths = candidates(uri);
  if (const std::string decoded = percentDecoded(uri); decoded != uri && uri.find("://") != std::string::npos)
    for (const std::string& path : candidates(decoded)) paths.push_back(path);
  std::error_code ignored;
  for (const std::string& path : paths)
    if (fs::is_regular_file(path, ignored)) return path;
  for (const std::string& name : {uri, percentDecoded(uri)}) {  // last, because it reads many folders
    if (!startsWith(name, kPackage)) continue;
    const auto [package, rest] = partsOf(name);
    for (const std::string& place : deeper(package)) {
      const std::string path = (fs::path(place) / rest).lexically_normal().string();
      if (fs::is_regular_file(path, ignored)) return path;
      if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
    }
  }
  for (const std::string& path : paths) {
    if (fs::is_directory(path, ignored)) throw Error(path + ": is a folder, expected a file");
    if (fs::exists(path, ignored)) throw Error(path + ": is a pipe or a device, expected a file");
  }
  std::string message = uri + ": no such file; tried";
  for (const std::string& path : paths) {
    const std::string why = whyNoFile(path);
    message += "\n  " + path + (why == "no such file" ? "" : " (" + why + ")");
  }
  if (startsWith(uri, kPackage)) {
    const std::string package = uri.substr(kPackage.size(), uri.find('/', kPackage.size()) - kPackage.size());
    message += "\nGive the folder that holds the package '" + package +
               "' as a package path (--package-path), or set ROS_PACKAGE_PATH or AMENT_PREFIX_PATH";
  }
  throw Error(message);
}

std::string PackagePath::folderOf(const std::string& name) const {
  const std::optional<std::string> path = filePathIn(name);
  std::error_code ignored;
  for (const std::string& text : {path.value_or(name), path ? percentDecoded(*path) : name})
    for (const std::string& folder : urdfFolders_)
      if (fs::exists(fs::path(folder) / text, ignored)) return folder;
  return urdfFolders_.front();
}

}  // namespace fcl_stpbv::detail
