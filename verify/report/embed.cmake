# cmake -D OUTPUT=assets.cc -D HTML=... -D CSS=... -D JS=... -P embed.cmake
# Writes the three files as byte arrays behind the names of assets_internal.h.
function(append_asset symbol file)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${hex}")
  string(APPEND code "constexpr unsigned char k${symbol}Bytes[] = {${bytes}0};\n")
  string(APPEND names "const std::string_view k${symbol}(reinterpret_cast<const char*>(k${symbol}Bytes), sizeof k${symbol}Bytes - 1);\n")
  set(code "${code}" PARENT_SCOPE)
  set(names "${names}" PARENT_SCOPE)
endfunction()

append_asset(PageHtml ${HTML})
append_asset(PageCss ${CSS})
append_asset(PageJs ${JS})
file(WRITE ${OUTPUT} "// Written by the build from verify/report/.
#include \"cguide/verify/report/assets_internal.h\"
namespace cguide::verify::report {
namespace {
${code}}
${names}}
")
