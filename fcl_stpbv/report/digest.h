// SHA-256, as sha256sum writes it.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::report {

std::string sha256(std::string_view content);

}  // namespace fcl_stpbv::report
