// The radii that -r and -R ask for: lengths, or "auto" for those that fit each body.
#pragma once

#include <optional>
#include <string>

#include "fcl_stpbv/volume/stp_bv.h"
#include "tools/number_check.h"

namespace fcl_stpbv::tools {

struct AskedRadii {
  std::optional<double> r, R;  ///< lengths; StpBvOptions' values where not given
  bool fitSmallRadius = false,
       fitBigRadius = false;  ///< those that fit the body's size, instead (docs/choosing_r_and_R.md)

  AskedRadii() = default;
  /// What the options say, "" where they are not given; R is fitted then where r is.
  AskedRadii(const std::string& rText, const std::string& RText)
      : fitSmallRadius(rText == kAuto), fitBigRadius(RText.empty() ? fitSmallRadius : RText == kAuto) {
    if (!rText.empty() && !fitSmallRadius) r = numberIn(rText);
    if (!RText.empty() && !fitBigRadius) R = numberIn(RText);
  }

  bool fits() const { return fitSmallRadius || fitBigRadius; }
  /// What is not fitted.
  StpBvOptions lengths() const {
    const StpBvOptions usual;
    return {r.value_or(usual.r), R.value_or(usual.R)};
  }

 private:
  static constexpr const char* kAuto = "auto";
};

}  // namespace fcl_stpbv::tools
