// Volumes kept on disk between runs, found by the content they were built from.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// A folder of built volumes. Any number of processes may share it. Whatever goes wrong with it, a missing or
/// read-only folder, a damaged entry, is cured by building anew and never reported.
///
/// Entries are believed where they carry the digest of what they were built from and of themselves, belong to
/// the user or to root, and can be written by nobody else: only who may already act as the user can forge
/// one.
class VolumeCache {
 public:
  /// `folder` is made when the first volume is kept; "" keeps nothing.
  explicit VolumeCache(std::string folder) : folder_(std::move(folder)) {}

  /// The volume built before from the same content, r and R, or else what `build` returns, which is kept.
  StpBv::Ptr volume(std::string_view content, const StpBvOptions& options,
                    const std::function<StpBv::Ptr()>& build);

  /// Whether there is an entry for it; a damaged one counts.
  bool has(std::string_view content, const StpBvOptions& options) const;

  int hits() const { return hits_; }

 private:
  std::string pathOf(std::string_view content, const StpBvOptions& options) const;
  StpBv::Ptr load(const std::string& path) const;
  void keep(const std::string& path, const StpBv& volume);

  std::string folder_;
  bool swept_ = false;
  int hits_ = 0;
};

}  // namespace fcl_stpbv::detail
