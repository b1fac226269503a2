// The format of entries: the file's name is a digest of the mesh's content and of the options. Its first line
// is a digest of the name and the entry. An entry that another user could have written, or whose digest does
// not match, is built anew.
#include "fcl_stpbv/robot/volume_cache.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>
#include <type_traits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/parts_text.h"

namespace fcl_stpbv::detail {
namespace {

namespace fs = std::filesystem;

// Change it when the same mesh gives other volumes, radii, parts or pair lists than before.
constexpr std::string_view kVersion = "fcl_stpbv volume cache 22\n";

// The name of an entry's file without its extension: the digest of the content that the entry was built from.
std::string keyOf(const std::string& path) { return fs::path(path).stem().string(); }

// Opens an entry. @returns -1 for a link, a pipe or a device, and for a file that another user could have
// written.
int openEntry(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  struct stat about {};
  if (file >= 0 && ::fstat(file, &about) == 0 && S_ISREG(about.st_mode) &&
      (about.st_uid == ::geteuid() || about.st_uid == 0) && (about.st_mode & (S_IWGRP | S_IWOTH)) == 0)
    return file;
  if (file >= 0) ::close(file);
  return -1;
}

std::string readEntry(const std::string& path) {
  const int file = openEntry(path);
  if (file < 0) return "";
  std::string text;
  char piece[1 << 16];
  for (ssize_t got = 0; (got = ::read(file, piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(got));
  ::close(file);
  return text;
}

std::string pathIn(const std::string& folder, const std::string& key, const char* extension) {
  return (fs::path(folder) / (digestOf(key) + extension)).string();
}

// The content of an entry, or "" if it cannot be trusted. An entry is a line with the digest of its key and
// the rest, then the volume's or the parts' own format.
std::string believed(const std::string& path) {
  std::string text = readEntry(path);
  const std::size_t line = text.find('\n');
  if (line == std::string::npos) return "";
  const std::string told = text.substr(0, line);
  text.replace(0, line, keyOf(path));
  if (digestOf(text) != told) return "";
  text.erase(0, text.find('\n') + 1);
  return text;
}

std::string textOf(const StpBv::Ptr& volume) {
  std::ostringstream out;
  saveStpBv(out, *volume);
  return out.str();
}
std::string textOf(const ConvexParts& parts) { return toText(parts); }
std::string textOf(const std::vector<double>& numbers) {
  std::string text;
  for (const double value : numbers) {
    appendNumber(text, value);
    text += '\n';
  }
  return text;
}
std::string textOf(const RolledHull& hull) {
  std::string text;
  const auto append = [&text](const std::vector<int>& indices) {
    text += std::to_string(indices.size());
    for (const int i : indices) text += " " + std::to_string(i);
    text += '\n';
  };
  append(hull.vertices);
  for (const std::vector<int>& ring : hull.faces) append(ring);
  return text;
}

void read(const std::string& text, const std::string& path, StpBv::Ptr& volume) {
  std::istringstream in(text);
  volume = loadStpBv(in, path);
}
void read(const std::string& text, const std::string& path, ConvexParts& parts) {
  parts = partsFromText(text, path);
}
void read(const std::string& text, const std::string& path, std::vector<double>& numbers) {
  TextScanner in(text, path);
  while (!in.atEnd()) numbers.push_back(in.number("a number"));
}
void read(const std::string& text, const std::string& path, RolledHull& hull) {
  TextScanner in(text, path);
  const auto indices = [&in] {
    std::vector<int> read(at(in.count("a number of points", 1, 2)));
    for (int& i : read) i = static_cast<int>(in.integer("a point", 0, std::numeric_limits<int>::max()));
    return read;
  };
  hull.vertices = indices();
  while (!in.atEnd()) hull.faces.push_back(indices());
}

}  // namespace

// Two streams of 64 bits take eight characters per step. Each step is mixed by a product and a shift.
std::string digestOf(std::string_view text) {
  std::uint64_t a = 0xcbf29ce484222325u, b = 0x9e3779b97f4a7c15u ^ text.size();
  for (std::size_t at = 0; at < text.size(); at += sizeof a) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data() + at, std::min(sizeof word, text.size() - at));
    a = (a ^ word) * 0xd6e8feb86659fd93u;
    a ^= a >> 32;
    b = (b + word) * 0xff51afd7ed558ccdu;
    b ^= b >> 29;
  }
  std::string hex;
  for (std::uint64_t word : {a, b})
    for (int shift = 60; shift >= 0; shift -= 4) hex += "0123456789abcdef"[word >> shift & 15];
  return hex;
}

std::string VolumeCache::pathOf(std::string_view content, const StpBvOptions& options) const {
  std::string key(kVersion);
  appendNumber(key, options.r);
  key += ' ';
  appendNumber(key, options.R);
  key += '\n';
  key += content;
  return pathIn(folder_, key, ".stpbv");
}

std::string VolumeCache::pathOf(std::string_view content, const PartsOptions& options) const {
  std::string key(kVersion);
  key += "parts " + std::to_string(options.most);
  for (const double value : {options.excess, options.effort}) {
    key += ' ';
    appendNumber(key, value);
  }
  key += '\n';
  key += content;
  return pathIn(folder_, key, ".parts");
}

std::string VolumeCache::pathOf(std::string_view content, const std::string& kind) const {
  std::string key(kVersion);
  key += kind + "\n";
  key += content;
  return pathIn(folder_, key, ("." + kind).c_str());
}

bool VolumeCache::has(std::string_view content, const StpBvOptions& options) const {
  const int file = folder_.empty() ? -1 : openEntry(pathOf(content, options));
  if (file >= 0) ::close(file);
  return file >= 0;
}

template <class Kept>
Kept VolumeCache::find(const std::string& path, const std::function<Kept()>& build) {
  if (folder_.empty()) return build();
  try {
    const std::string text = believed(path);
    if (!text.empty()) {
      Kept kept;
      read(text, path, kept);
      hits_ += std::is_same_v<Kept, StpBv::Ptr> || std::is_same_v<Kept, ConvexParts>;
      return kept;
    }
  } catch (const std::exception&) {
    // the entry is built anew
  }
  const Kept built = build();
  keep(path, textOf(built));
  return built;
}

StpBv::Ptr VolumeCache::volume(std::string_view content, const StpBvOptions& options,
                               const std::function<StpBv::Ptr()>& build) {
  return find(pathOf(content, options), build);
}

ConvexParts VolumeCache::parts(std::string_view content, const PartsOptions& options,
                               const std::function<ConvexParts()>& build) {
  return find(pathOf(content, options), build);
}

RolledHull VolumeCache::convexHull(const std::vector<Eigen::Vector3d>& cloud) {
  const std::string_view content(reinterpret_cast<const char*>(cloud.data()), cloud.size() * sizeof cloud[0]);
  RolledHull hull = find<RolledHull>(pathOf(content, "hull"), [&cloud] { return detail::convexHull(cloud); });
  const auto exist = [&cloud](const std::vector<int>& points) {
    return std::all_of(points.begin(), points.end(), [&cloud](int i) { return at(i) < cloud.size(); });
  };
  const bool whole = exist(hull.vertices) && std::all_of(hull.faces.begin(), hull.faces.end(), exist);
  return whole ? hull : detail::convexHull(cloud);
}

std::vector<double> VolumeCache::numbers(std::string_view content, const std::string& kind,
                                         const std::function<std::vector<double>()>& build) {
  return find(pathOf(content, kind), build);
}

void VolumeCache::keep(const std::string& path, const std::string& entry) {
  try {
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    std::call_once(swept_, [this] { sweepTemporaries(folder_); });
    const std::string text = "\n" + entry;
    atomicWriteOwn(path, digestOf(keyOf(path) + text) + text);
  } catch (const std::exception&) {
    return;  // the entry is built anew next time
  }
}

}  // namespace fcl_stpbv::detail
