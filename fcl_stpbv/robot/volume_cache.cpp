// See volume_cache.h.
#include "fcl_stpbv/robot/volume_cache.h"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/io/stpbv_file.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv {
namespace {

namespace fs = std::filesystem;

// Changes when the builder gives other volumes for the same points.
constexpr std::string_view kVersion = "fcl_stpbv volume cache 2\n";

// Two streams of 64 bits: FNV-1a, and the same steps over a mixed state. Guards against accidents, not
// against somebody who may write into the user's own cache.
std::string digest(std::string_view text) {
  std::uint64_t a = 0xcbf29ce484222325u, b = 0x9e3779b97f4a7c15u;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    a = (a ^ byte) * 0x100000001b3u;
    b = (b + byte) * 0xff51afd7ed558ccdu;
    b ^= b >> 29;
  }
  std::string hex;
  for (std::uint64_t word : {a, b})
    for (int shift = 60; shift >= 0; shift -= 4) hex += "0123456789abcdef"[word >> shift & 15];
  return hex;
}

}  // namespace

std::string VolumeCache::defaultFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && fs::path(cache).is_absolute()) return (fs::path(cache) / "fcl_stpbv").string();
  const char* home = std::getenv("HOME");
  return home && fs::path(home).is_absolute() ? (fs::path(home) / ".cache" / "fcl_stpbv").string() : "";
}

StpBv::Ptr VolumeCache::volume(std::string_view content, const StpBvOptions& options,
                               const std::function<StpBv::Ptr()>& build) {
  if (folder_.empty()) return build();
  std::string key(kVersion);
  appendNumber(key, options.r);
  key += ' ';
  appendNumber(key, options.R);
  key += '\n';
  key += content;
  const std::string path = (fs::path(folder_) / (digest(key) + ".stpbv")).string();
  StpBv::Ptr volume = load(path);
  if (volume) {
    ++hits_;
    return volume;
  }
  volume = build();
  keep(path, *volume);
  return volume;
}

// An entry is a line with the digest of the rest, then the volume's own format.
StpBv::Ptr VolumeCache::load(const std::string& path) const {
  try {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return nullptr;
    const std::string text = readText(path);
    const std::size_t line = text.find('\n');
    if (line == std::string::npos || digest(std::string_view(text).substr(line + 1)) != text.substr(0, line))
      return nullptr;
    std::istringstream in(text.substr(line + 1));
    return loadStpBv(in, path);
  } catch (const std::exception&) {
    return nullptr;
  }
}

void VolumeCache::keep(const std::string& path, const StpBv& volume) const {
  try {
    std::error_code ignored;
    fs::create_directories(folder_, ignored);
    std::ostringstream out;
    saveStpBv(out, volume);
    atomicWrite(path, digest(out.str()) + "\n" + out.str());
  } catch (const std::exception&) {
    return;  // built again next time
  }
}

}  // namespace fcl_stpbv
