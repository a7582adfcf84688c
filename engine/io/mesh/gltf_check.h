#pragma once

#include <cstddef>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "engine/core/result.h"
#include "engine/io/mesh/mesh_message.h"

namespace reljef::io {

/// Reads what the JSON of a glTF 2.0 file says of its size, before importing costs time. Fails,
/// with what was found, on more than max_mesh_triangles, max_gltf_nodes, max_gltf_vertices and
/// max_mesh_parts materials in use, on nodes nested deeper than max_gltf_depth, and on required
/// extensions that the importer lacks.
Result<void> check_gltf(const nlohmann::json& file);
inline constexpr std::size_t max_gltf_depth = 500;
inline constexpr std::size_t max_gltf_nodes = 1'000'000; ///< of the scene; children of each parent
inline constexpr std::size_t max_gltf_vertices = 6 * max_mesh_triangles; ///< of all primitives

/// Fails on JSON that is nested deeper than max_gltf_depth, before parsing it takes stack.
Result<void> check_gltf_depth(std::string_view json);

/// Fails if an accessor of a triangle's corners has a type that glTF does not allow there, or
/// reaches out of its buffer view, or that view out of its buffer. The error names the key.
Result<void> check_gltf_accessors(const nlohmann::json& file);

} // namespace reljef::io
