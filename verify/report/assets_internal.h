#pragma once

#include <string_view>

namespace cguide::verify::report {

/** The page's template, style and bundled script; the build writes their definitions. */
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

}  // namespace cguide::verify::report
