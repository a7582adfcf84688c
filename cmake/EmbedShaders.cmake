# Writes OUTPUT, a C++ file that defines every shader file as text.
# Run as: cmake -DSHADERS=a;b -DFOLDER=dir -DOUTPUT=file.cpp -P EmbedShaders.cmake
set(entries "")
foreach(shader IN LISTS SHADERS)
  file(READ "${FOLDER}/${shader}" text)
  string(APPEND entries "    {\"${shader}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "#include \"engine/render/shader_library.h\"

#include <array>

namespace reljef::render {
namespace {

constexpr EmbeddedShader shaders[] = {
${entries}};

} // namespace

std::span<const EmbeddedShader> embedded_shaders() { return shaders; }

} // namespace reljef::render
")
