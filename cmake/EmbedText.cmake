# reljef_embed(OUTPUT file.cpp HEADER a/b.h NAMESPACE reljef::x TYPE Entry FUNCTION entries
#              FOLDER dir FILES a b ... [STEM])
# makes a C++ file that defines `std::span<const TYPE> FUNCTION()`, each entry a {name, text} of one
# file; STEM leaves the extension out of the name.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(reljef_embed_script ${CMAKE_CURRENT_LIST_FILE})
  function(reljef_embed)
    cmake_parse_arguments(EMBED "STEM" "OUTPUT;HEADER;NAMESPACE;TYPE;FUNCTION;FOLDER" "FILES" ${ARGN})
    list(TRANSFORM EMBED_FILES PREPEND ${EMBED_FOLDER}/ OUTPUT_VARIABLE paths)
    add_custom_command(OUTPUT ${EMBED_OUTPUT}
      COMMAND ${CMAKE_COMMAND} "-DFILES=${EMBED_FILES}" -DFOLDER=${EMBED_FOLDER}
              -DOUTPUT=${EMBED_OUTPUT} -DHEADER=${EMBED_HEADER} -DNAMESPACE=${EMBED_NAMESPACE}
              -DTYPE=${EMBED_TYPE} -DFUNCTION=${EMBED_FUNCTION} -DSTEM=${EMBED_STEM}
              -P ${reljef_embed_script}
      DEPENDS ${paths} ${reljef_embed_script}
      COMMENT "Embedding ${EMBED_FOLDER}" VERBATIM)
    # Not there yet where rooms are only read, not built.
    set_source_files_properties(${EMBED_OUTPUT} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endfunction()
  return()
endif()

set(entries "")
foreach(file IN LISTS FILES)
  file(READ "${FOLDER}/${file}" text)
  set(name "${file}")
  if(STEM)
    get_filename_component(name "${file}" NAME_WE)
  endif()
  string(APPEND entries "    {\"${name}\", R\"text(${text})text\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {

constexpr ${TYPE} entries[] = {
${entries}};

} // namespace

std::span<const ${TYPE}> ${FUNCTION}() { return entries; }

} // namespace ${NAMESPACE}
")
