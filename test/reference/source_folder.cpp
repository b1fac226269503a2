// See source_folder.h. The only file compiled with the path, so that the others are the same in every folder.
#include "test/reference/source_folder.h"

namespace fcl_stpbv::test {

std::string sourceFolder() { return FCL_STPBV_SOURCE_DIR; }

}  // namespace fcl_stpbv::test
