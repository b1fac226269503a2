// See source_folder.h. This is the only file compiled with the path, so the object files of all others are
// the same in every folder.
#include "test/reference/source_folder.h"

namespace fcl_stpbv::test {

std::string sourceFolder() { return FCL_STPBV_SOURCE_DIR; }

}  // namespace fcl_stpbv::test
