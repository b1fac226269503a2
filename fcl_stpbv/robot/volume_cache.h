// A disk cache for volumes, convex parts and hulls of meshes, and measurements of them. The key is a digest
// of the content from which an entry was built.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// A digest of 32 characters (128 bits). It is not cryptographic: it avoids accidental collisions, but not
/// deliberate ones.
std::string digestOf(std::string_view content);

/// A cache folder. Any number of processes and threads may share it. If anything is wrong with it (a missing
/// or read-only folder, a damaged entry), the data are built anew, without an error.
///
/// An entry is used only if it contains the digests of its source and of itself, belongs to the user or to
/// root, and is not writable by anybody else. So only somebody who can already act as the user could forge
/// one.
class VolumeCache {
 public:
  /// `folder` is created when the first entry is stored; "" stores nothing.
  explicit VolumeCache(std::string folder) : folder_(std::move(folder)) {}

  /// The volume stored for the same content, r and R, or else the result of `build`, which is then stored.
  StpBv::Ptr volume(std::string_view content, const StpBvOptions& options,
                    const std::function<StpBv::Ptr()>& build);

  /// The convex parts of a mesh in the same way. `content` is that of the whole mesh.
  ConvexParts parts(std::string_view content, const PartsOptions& options,
                    const std::function<ConvexParts()>& build);

  /// The convex hull of a cloud that is finite and not empty: the stored one, or else a new one. @throws
  /// Error as convexHull().
  RolledHull convexHull(const std::vector<Eigen::Vector3d>& cloud);

  /// Finite numbers that depend on `content`, in the same way. `kind`, a short word, is the end of the
  /// entry's name. The entry may have any number of them: the caller must check it.
  std::vector<double> numbers(std::string_view content, const std::string& kind,
                              const std::function<std::vector<double>()>& build);

  /// Whether there is an entry for a volume; a damaged one counts.
  bool has(std::string_view content, const StpBvOptions& options) const;

  /// Number of times that an entry for a volume or parts was used.
  int hits() const { return hits_; }

 private:
  template <class Kept>
  Kept find(const std::string& path, const std::function<Kept()>& build);
  std::string pathOf(std::string_view content, const StpBvOptions& options) const;
  std::string pathOf(std::string_view content, const PartsOptions& options) const;
  std::string pathOf(std::string_view content, const std::string& kind) const;
  void keep(const std::string& path, const std::string& text);

  std::string folder_;
  std::once_flag swept_;
  std::atomic<int> hits_{0};
};

}  // namespace fcl_stpbv::detail
