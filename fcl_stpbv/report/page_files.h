// The page's own files and three.js, as text inside the program (made by page/embed.cmake).
#pragma once

#include <string_view>

namespace fcl_stpbv::report {

extern const std::string_view kPageHtml;  ///< with marks where the other files and the report are inserted
extern const std::string_view kPageStyle;
extern const std::string_view kPageScript;
extern const std::string_view kPageThree;  ///< three.js and its orbit controls

}  // namespace fcl_stpbv::report
