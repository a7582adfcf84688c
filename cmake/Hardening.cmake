# Hardened code in all targets below the including folder; programs that use the installed library
# keep their own flags. Flags of the user (CMAKE_CXX_FLAGS, dpkg-buildflags) follow these and win.
#
#   stack protectors, stack clash protection, control-flow protection (x86)
#   _FORTIFY_SOURCE=2 with optimisation, unless compiler or user define another
#   checked preconditions of the standard library (_GLIBCXX_ASSERTIONS changes no ABI)
#   position-independent programs, full RELRO

include(CheckCXXCompilerFlag)
include(CheckCXXSourceCompiles)

set(reljef_hardening "-fPIE")
foreach(flag stack-protector-strong stack-clash-protection cf-protection)
  check_cxx_compiler_flag(-f${flag} RELJEF_HAS_${flag})
  if(RELJEF_HAS_${flag})
    string(APPEND reljef_hardening " -f${flag}")
  endif()
endforeach()
string(PREPEND CMAKE_CXX_FLAGS "${reljef_hardening} ")
string(PREPEND CMAKE_C_FLAGS "${reljef_hardening} ")
string(PREPEND CMAKE_EXE_LINKER_FLAGS "-pie -Wl,-z,relro,-z,now ")
string(PREPEND CMAKE_MODULE_LINKER_FLAGS "-Wl,-z,relro,-z,now ")

set(CMAKE_REQUIRED_FLAGS -O2) # some compilers define it themselves
check_cxx_source_compiles("#ifdef _FORTIFY_SOURCE\n#error\n#endif\nint main() {}" RELJEF_UNFORTIFIED)
unset(CMAKE_REQUIRED_FLAGS)
if(RELJEF_UNFORTIFIED)
  add_compile_definitions($<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:_FORTIFY_SOURCE=2>)
endif()
add_compile_definitions(_GLIBCXX_ASSERTIONS)
