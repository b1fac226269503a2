// Where the project's sources and data are, for tests and benchmarks that read them.
#pragma once

#include <string>

namespace fcl_stpbv::test {

/// The project's top folder, absolute, without a slash at its end.
std::string sourceFolder();

}  // namespace fcl_stpbv::test
