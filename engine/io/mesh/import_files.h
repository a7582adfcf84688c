#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include <assimp/DefaultIOSystem.h>

namespace reljef::io {

inline constexpr std::size_t max_library_materials = 20'000; ///< of all files that an OBJ names

/// The files that Assimp may open for a mesh file: those in and below its folder, of max_mesh_bytes
/// together, and each material library once, because an OBJ may name one a million times. Of an OBJ
/// file it sees no groups, objects, lines and points.
class ImportFiles : public Assimp::DefaultIOSystem {
public:
    /// `contents`: what Assimp reads instead of the file's own bytes; empty: those.
    ImportFiles(std::filesystem::path file, std::string contents);

    bool Exists(const char* name) const override;
    Assimp::IOStream* Open(const char* name, const char* mode) override;

    /// What is wrong with the files that were opened, as an error; empty: nothing.
    [[nodiscard]] const std::string& problem() const { return problem_; }

private:
    bool add_materials(const std::filesystem::path& file);

    std::filesystem::path file_;
    std::filesystem::path folder_;
    std::string contents_;
    bool is_obj_;
    std::map<std::filesystem::path, std::uintmax_t> openings_;
    std::uintmax_t left_; // bytes
    std::size_t materials_ = 0;
    std::string problem_;
};

} // namespace reljef::io
