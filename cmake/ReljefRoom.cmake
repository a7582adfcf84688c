# A room is a static library of one folder. Files are listed, never globbed.
#
#   reljef_room(NAME [HEADERS a.h ...] [SOURCES a.cpp ...] [LINK target ...] [PRIVATE_LINK target ...])
#   reljef_test(ROOM SOURCES a_test.cpp ... [LINK target ...] [SHARDS COUNT] [COST SECONDS]
#               [ALONE FILTER] [SANITIZED FILTER] [OPTIMISED])
#               SHARDS: processes that share the tests
#               ALONE: tests of windows, which get a display to themselves
#               SANITIZED: what the sanitizers run by default (tests of input, memory and threads);
#                          none without it
#               READERS: tests of what reads files and other input; CI runs these under sanitizers
#               OPTIMISED: the tests themselves compute much
# Tests that run by default have the label `default`; target `default_tests` builds their programs. So do label
# `readers` and target `readers_tests` for READERS.

add_library(reljef_warnings INTERFACE)
target_compile_options(reljef_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
  $<$<AND:$<BOOL:${PROJECT_IS_TOP_LEVEL}>,$<CXX_COMPILER_ID:GNU>>:-Werror> # warnings are gcc's to give
  # clang-tidy does not know the next one, and g++ not its name for that.
  -Wno-unknown-warning-option -Wno-restrict # g++ 12 sees overlaps in std::string that are none (GCC bug 105651)
  # A room compiled as one file: a local name may be that of another file's.
  $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-shadow>)

add_library(reljef_options INTERFACE)
set_target_properties(reljef_options PROPERTIES EXPORT_NAME options)
target_compile_features(reljef_options INTERFACE cxx_std_20)
target_include_directories(reljef_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/reljef>)
target_link_libraries(reljef_options INTERFACE glm::glm)
target_compile_definitions(reljef_options INTERFACE
  GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_ENABLE_EXPERIMENTAL)
if(RELJEF_SANITIZE)
  if("undefined" IN_LIST RELJEF_SANITIZE) # g++ leaves these out of `undefined`
    list(APPEND RELJEF_SANITIZE float-cast-overflow float-divide-by-zero)
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU) # clang has it in `undefined`
      list(APPEND RELJEF_SANITIZE bounds-strict)
    endif()
  endif()
  string(REPLACE ";" "," reljef_sanitizers "${RELJEF_SANITIZE}")
  target_compile_options(reljef_options INTERFACE
    -fsanitize=${reljef_sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if("address" IN_LIST RELJEF_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # What the address sanitizer finds as well; and alignment, which clang checks in the fuzz targets.
    # They take half of the compiler's time.
    # Without the checks, g++ 12 warns of what empty optionals hold.
    target_compile_options(reljef_options INTERFACE
      -fno-sanitize=null,object-size,vptr,pointer-overflow,alignment -Wno-maybe-uninitialized)
  endif()
  target_link_options(reljef_options INTERFACE -fsanitize=${reljef_sanitizers})
endif()

# Unless told so, g++ collects its garbage from 128 MB on again and again: a sixth of its time.
if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=1000000>) # kB
endif()

# Compiled once for all rooms: a clean build takes a third less time.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cpp CONTENT "")
add_library(reljef_precompiled OBJECT ${PROJECT_BINARY_DIR}/precompiled.cpp)
target_link_libraries(reljef_precompiled PRIVATE reljef_options reljef_warnings fmt::fmt)
target_precompile_headers(reljef_precompiled PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h)

# Rooms that compute little are only checked: as for a debugger, in 2/3 of the time; g++ 12 then warns of
# what empty optionals hold.
add_library(reljef_quickly_sanitized INTERFACE)
if(RELJEF_SANITIZE)
  target_compile_options(reljef_quickly_sanitized INTERFACE -Og -Wno-maybe-uninitialized)
  if("address" IN_LIST RELJEF_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # The same checks as calls: compiled faster; where much is computed, they take half as long again.
    target_compile_options(reljef_quickly_sanitized INTERFACE --param=asan-instrumentation-with-call-threshold=0)
  endif()
endif()

# Programs, tests and the session only call the other rooms, where the time goes: they need not be
# optimised as these are.
add_library(reljef_quick_build INTERFACE)
target_compile_options(reljef_quick_build INTERFACE $<$<CONFIG:Release>:-O1>)
target_link_libraries(reljef_quick_build INTERFACE reljef_quickly_sanitized)
add_library(reljef_test_build INTERFACE)
if(RELJEF_SANITIZE)
  # Without the lines of the tests: reports name their functions.
  target_compile_options(reljef_test_build INTERFACE -O0 -g0
    -fno-sanitize=undefined,float-cast-overflow,float-divide-by-zero,bounds-strict)
elseif(CMAKE_BUILD_TYPE STREQUAL Release)
  target_compile_options(reljef_test_build INTERFACE -Og -Wno-maybe-uninitialized)
endif()

# A source of the calling folder that Highway compiles once for each instruction set. Rounding decides on
# which side of a border a ray is: no product may be fused with a sum in one expression and not in another
# of the same form. Lanes that miss divide by zero, too; their results are not taken. Use after scope is
# left to the rooms around: checked for each of the thousands of inlined vectors, it makes g++ 12 compile
# ten times as long.
function(reljef_simd_source SOURCE)
  set(options -ffp-contract=off -fno-sanitize=float-divide-by-zero -fno-sanitize-address-use-after-scope)
  if(CMAKE_BUILD_TYPE STREQUAL Release)
    list(APPEND options -O2) # as fast as -O3 (within 1 %), compiled in 2/3 of the time
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    list(APPEND options -march=armv8-a+crypto) # what Highway means by NEON
  endif()
  set_source_files_properties(${SOURCE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
    SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "${options}")
endfunction()

function(reljef_room NAME)
  cmake_parse_arguments(ROOM "" "" "HEADERS;SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  set(target reljef_${NAME})
  add_library(${target} STATIC ${ROOM_SOURCES})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${ROOM_HEADERS})
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME ${NAME})
  set_property(GLOBAL APPEND PROPERTY RELJEF_ROOMS ${target})
  add_library(reljef::${NAME} ALIAS ${target})
  target_link_libraries(${target} PUBLIC reljef_options ${ROOM_LINK}
                                  PRIVATE $<BUILD_INTERFACE:reljef_warnings> ${ROOM_PRIVATE_LINK})
  target_precompile_headers(${target} REUSE_FROM reljef_precompiled)
  if(RELJEF_CHECK_HEADERS AND NOT CMAKE_CURRENT_SOURCE_DIR MATCHES "^${PROJECT_SOURCE_DIR}/(app|bench)")
    set_property(GLOBAL APPEND PROPERTY RELJEF_CHECKED_ROOMS ${target})
  endif()
endfunction()

# reljef::reljef, all rooms of the library: what a program links that opens a terrain and draws it.
function(reljef_umbrella)
  add_library(reljef_reljef INTERFACE)
  set_target_properties(reljef_reljef PROPERTIES EXPORT_NAME reljef)
  target_link_libraries(reljef_reljef INTERFACE reljef_session)
  add_library(reljef::reljef ALIAS reljef_reljef)
  set_property(GLOBAL APPEND PROPERTY RELJEF_ROOMS reljef_reljef reljef_options reljef_glad)
  get_property(rooms GLOBAL PROPERTY RELJEF_ROOMS)
  set(reljef_library ${rooms} PARENT_SCOPE)
  if(RELJEF_CHECK_HEADERS)
    reljef_check_headers()
  endif()
endfunction()

# Compiles each header of the library's rooms as if by itself (target `headers`). A header may follow
# those that it includes anyway: they change nothing for it. So each program starts with a small
# header, and each further one includes all before it. This halves the programs and their time.
function(reljef_check_headers)
  get_property(rooms GLOBAL PROPERTY RELJEF_CHECKED_ROOMS)
  set(sized)
  foreach(room IN LISTS rooms)
    get_target_property(headers ${room} HEADER_SET)
    list(FILTER headers INCLUDE REGEX "\\.h$")
    foreach(path IN LISTS headers)
      cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE header)
      set(room_of_${header} ${room})
      reljef_included_by(${header} included)
      list(LENGTH included size)
      math(EXPR size "${size} + 10000") # sorts as text
      set(included_by_${header} ${included})
      set(size_of_${header} ${size})
      list(APPEND sized "${size} ${header}")
    endforeach()
  endforeach()
  list(SORT sized ORDER DESCENDING)
  list(TRANSFORM sized REPLACE "^[0-9]+ " "")
  foreach(last IN LISTS sized)
    if(done_${last})
      continue()
    endif()
    set(program)
    set(header ${last})
    while(header)
      set(done_${header} TRUE)
      string(PREPEND program "#include \"${header}\"\n")
      set(next)
      set(size 0)
      foreach(candidate IN LISTS included_by_${header})
        if(room_of_${candidate} AND NOT done_${candidate} AND size_of_${candidate} GREATER size)
          set(next ${candidate})
          set(size ${size_of_${candidate}})
        endif()
      endforeach()
      set(header ${next})
    endwhile()
    set(source ${PROJECT_BINARY_DIR}/headers/${last}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "${program}")
    list(APPEND sources_${room_of_${last}} ${source})
  endforeach()
  add_custom_target(headers)
  foreach(room IN LISTS rooms)
    if(sources_${room})
      add_library(${room}_headers OBJECT EXCLUDE_FROM_ALL ${sources_${room}})
      set_target_properties(${room}_headers PROPERTIES UNITY_BUILD OFF)
      # Not the room itself: it would be built first.
      target_link_libraries(${room}_headers PRIVATE reljef_options reljef_warnings fmt::fmt)
      target_include_directories(${room}_headers PRIVATE
        $<TARGET_PROPERTY:${room},INTERFACE_INCLUDE_DIRECTORIES>)
      target_precompile_headers(${room}_headers REUSE_FROM reljef_precompiled)
      add_dependencies(headers ${room}_headers)
    endif()
  endforeach()
endfunction()

# All files of the project that a header includes, through others, too.
function(reljef_included_by HEADER RESULT)
  get_property(known GLOBAL PROPERTY RELJEF_INCLUDED_BY_${HEADER} SET)
  if(NOT known)
    set(found)
    if(EXISTS ${PROJECT_SOURCE_DIR}/${HEADER})
      set_property(GLOBAL PROPERTY RELJEF_INCLUDED_BY_${HEADER} "") # ends a cycle
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${HEADER})
      file(STRINGS ${PROJECT_SOURCE_DIR}/${HEADER} lines REGEX "^#include \"")
      foreach(line IN LISTS lines)
        string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" direct "${line}")
        reljef_included_by(${direct} further)
        list(APPEND found ${direct} ${further})
      endforeach()
      list(REMOVE_DUPLICATES found)
    endif()
    set_property(GLOBAL PROPERTY RELJEF_INCLUDED_BY_${HEADER} "${found}")
  endif()
  get_property(found GLOBAL PROPERTY RELJEF_INCLUDED_BY_${HEADER})
  set(${RESULT} ${found} PARENT_SCOPE)
endfunction()

find_program(RELJEF_XVFB_RUN xvfb-run)

# SHARDS processes that share a program's tests, with some labels and the caller's `properties` and
# `launcher` (a command before the program, or none); ./dev adds up what their reports tell. FILTER is
# GoogleTest's; empty: all tests.
function(reljef_add_shards NAME PROGRAM SHARDS FILTER)
  if(FILTER)
    set(filter --gtest_filter=${FILTER})
  endif()
  math(EXPR last "${SHARDS} - 1")
  foreach(shard RANGE ${last})
    set(test ${NAME}.${shard})
    add_test(NAME ${test} COMMAND ${launcher} ${CMAKE_COMMAND} -E env
             GTEST_TOTAL_SHARDS=${SHARDS} GTEST_SHARD_INDEX=${shard} $<TARGET_FILE:${PROGRAM}>
             --gtest_brief=1 --gtest_output=xml:${PROJECT_BINARY_DIR}/test-reports/${test}.xml ${filter})
    set_tests_properties(${test} PROPERTIES ${properties} LABELS "${ARGN}")
  endforeach()
endfunction()

function(reljef_test ROOM)
  cmake_parse_arguments(TEST "OPTIMISED;READERS" "ALONE;SHARDS;COST;SANITIZED" "SOURCES;LINK" ${ARGN})
  set(target reljef_${ROOM}_test)
  add_executable(${target} ${TEST_SOURCES})
  set(build reljef_test_build)
  if(TEST_OPTIMISED AND NOT RELJEF_SANITIZE)
    set(build reljef_quick_build)
  endif()
  target_link_libraries(${target} PRIVATE reljef_test_support ${TEST_LINK} reljef_warnings ${build}
                                          GTest::gtest GTest::gmock GTest::gtest_main)
  if(TARGET reljef_test_precompiled AND build STREQUAL reljef_test_build) # otherwise optimised in another way
    target_precompile_headers(${target} REUSE_FROM reljef_test_precompiled)
  endif()
  set(properties TIMEOUT 2700) # the longest take six minutes on two processors; others may be busy
  if("address" IN_LIST RELJEF_SANITIZE)
    # Where the runtime of g++ 12 watches thread-local storage, it takes some of glibc's blocks for
    # those of a glibc before 2.25, and the search for leaks ends with a fault of its own, now and then.
    set(leaks "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/support/lsan.supp:print_suppressions=0")
    list(APPEND properties ENVIRONMENT "${leaks}\\;ASAN_OPTIONS=intercept_tls_get_addr=0")
    target_link_libraries(${target} PRIVATE reljef_keep_loaded)
  endif()
  if(NOT TEST_SHARDS)
    set(TEST_SHARDS 1)
  endif()
  if(TEST_COST)
    list(APPEND properties COST ${TEST_COST}) # the longest begin first
  endif()
  # A process for each test would start programs that take a second under the sanitizers: the tests
  # of a room share a few.
  set(label)
  if(NOT RELJEF_SANITIZE OR TEST_SANITIZED)
    add_dependencies(default_tests ${target})
  endif()
  if(NOT RELJEF_SANITIZE OR TEST_SANITIZED STREQUAL "*")
    set(label default)
  endif()
  if(TEST_READERS)
    add_dependencies(readers_tests ${target})
    list(APPEND label readers)
  endif()
  if(RELJEF_SANITIZE AND TEST_SANITIZED AND NOT TEST_SANITIZED STREQUAL "*")
    reljef_add_shards(${ROOM}.sanitized ${target} ${TEST_SHARDS} "${TEST_SANITIZED}" ${ROOM} default)
    string(APPEND left_out ":${TEST_SANITIZED}")
  endif()
  if(TEST_ALONE)
    if(RELJEF_XVFB_RUN)
      set(launcher ${RELJEF_XVFB_RUN} -a -s "-noreset -screen 0 1280x1024x24")
    endif()
    reljef_add_shards(${ROOM}.alone ${target} 1 "${TEST_ALONE}" ${ROOM} ${label})
    unset(launcher)
    if(NOT RELJEF_XVFB_RUN)
      set_tests_properties(${ROOM}.alone.0 PROPERTIES RUN_SERIAL ON)
    endif()
    string(APPEND left_out ":${TEST_ALONE}")
  endif()
  string(REGEX REPLACE "^:" "-" left_out "${left_out}")
  reljef_add_shards(${ROOM} ${target} ${TEST_SHARDS} "${left_out}" ${ROOM} ${label})
endfunction()
