// Volumes kept on disk between runs, found by the content they were built from.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// A folder of built volumes. Any number of processes may share it. Whatever goes wrong with it, a missing or
/// read-only folder, a damaged entry, is cured by building anew and never reported.
class VolumeCache {
 public:
  /// The usual place: $XDG_CACHE_HOME/fcl_stpbv, else ~/.cache/fcl_stpbv; "" where neither is known.
  static std::string defaultFolder();

  /// `folder` is made when the first volume is kept; "" keeps nothing.
  explicit VolumeCache(std::string folder) : folder_(std::move(folder)) {}

  /// The volume built before from the same content, r and R, or else what `build` returns, which is kept.
  StpBv::Ptr volume(std::string_view content, const StpBvOptions& options,
                    const std::function<StpBv::Ptr()>& build);

  int hits() const { return hits_; }

 private:
  StpBv::Ptr load(const std::string& path) const;
  void keep(const std::string& path, const StpBv& volume) const;

  std::string folder_;
  int hits_ = 0;
};

}  // namespace fcl_stpbv
