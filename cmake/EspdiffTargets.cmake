# EspdiffTargets.cmake: flags shared by all targets of the project.

add_library(espdiff_flags INTERFACE)
target_include_directories(espdiff_flags INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include/espdiff>)
target_compile_features(espdiff_flags INTERFACE cxx_std_17)
# No contraction and no fast-math, so that the same source gives the same bits on every instruction set.
target_compile_options(espdiff_flags INTERFACE
  $<BUILD_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off -fvisibility=hidden -Wall -Wextra -Wpedantic -Wshadow>>
  $<BUILD_INTERFACE:$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${ESPDIFF_WERROR}>>:-Werror>>)

# espdiff_add_library(name SOURCES ... [LIBRARIES ...]): a static library for one room. Loops that need -O3 are the engine's.
function(espdiff_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC espdiff_flags ${ARG_LIBRARIES} PRIVATE ${ARG_PRIVATE_LIBRARIES})
  target_compile_options(${name} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O2>)
endfunction()

# espdiff_combine(OUTPUT N SOURCE ...): sets OUTPUT to generated .cu files, of the binary folder, that include N sources of
# cuda/ each.
function(espdiff_combine output n)
  set(combined "")
  while(ARGN)
    list(SUBLIST ARGN 0 ${n} part)
    list(REMOVE_ITEM ARGN ${part})
    list(LENGTH combined number)
    list(TRANSFORM part REPLACE "(.+)" "#include \"cuda/\\1\"\n")
    string(CONCAT content ${part})
    file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/combined_${number}.cu CONTENT "${content}")
    list(APPEND combined combined_${number}.cu)
  endwhile()
  set(${output} ${combined} PARENT_SCOPE)
endfunction()

# espdiff_optimize_little(target ...): what takes longer to compile than it ever runs: options, commands, reports, pictures,
# tests, and what drives the comparisons of a pair, a matrix, a trajectory or an ensemble.
function(espdiff_optimize_little)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O1>)
  endforeach()
endfunction()

# espdiff_table_of(OUTPUT HEADER TYPE TABLE SUFFIX NAME...): writes a source with TABLE(), a std::vector of what the
# functions NAME_SUFFIX() return, in the order of the names. HEADER declares TYPE and TABLE().
function(espdiff_table_of output header type table suffix)
  set(declarations "")
  set(calls "")
  foreach(name ${ARGN})
    string(APPEND declarations "${type} ${name}_${suffix}();\n")
    string(APPEND calls "${name}_${suffix}(), ")
  endforeach()
  cmake_path(GET output FILENAME file)
  file(CONFIGURE OUTPUT ${output} @ONLY CONTENT
"// @file@: a table, made from the list in src/CMakeLists.txt.
#include \"@header@\"

namespace espdiff {

@declarations@
const std::vector<@type@>& @table@() {
  static const std::vector<@type@> all = {@calls@};
  return all;
}

}  // namespace espdiff
")
endfunction()
