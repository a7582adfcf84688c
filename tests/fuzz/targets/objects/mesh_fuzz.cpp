// Answers of the program that imports meshes.
#include <span>

#include "engine/io/mesh/mesh_message.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/fuzz_targets.h"

namespace reljef::fuzz {

void mesh_target(std::string_view input) {
    const auto parts = io::decoded_parts(std::as_bytes(std::span(input)));
    if (!parts) {
        expect(!parts.error().message.empty(), "a reason");
        return;
    }
    for (const io::MeshPart& part : *parts) {
        const std::size_t vertices = part.mesh.positions.size();
        expect(part.mesh.normals.size() == vertices, "a normal for each vertex");
        expect(part.mesh.texture_coordinates.size() == vertices, "a texture coordinate, too");
        for (const std::uint32_t index : part.mesh.indices) {
            expect(index < vertices, "corners that are vertices");
        }
    }
}

} // namespace reljef::fuzz
