#include "engine/io/mesh/mesh_file.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/core/atomic_file.h"
#include "engine/core/memory_file.h"
#include "engine/io/image/image.h"
#include "engine/io/mesh/mesh_import.h"
#include "engine/io/mesh/mesh_message.h"
#include "engine/io/mesh/near_file.h"
#include "engine/io/mesh/obj_contents.h"

namespace reljef::io {
namespace {

namespace fs = std::filesystem;

Result<Image> picture_in(std::span<const std::byte> bytes) {
    const auto file = MemoryFile::create();
    if (!file) {
        return file.error();
    }
    while (!bytes.empty()) {
        const ssize_t size = ::write(file->descriptor(), bytes.data(), bytes.size());
        if (size <= 0) {
            return Error{"memory is too short for it"};
        }
        bytes = bytes.subspan(static_cast<std::size_t>(size));
    }
    return read_image(file->path());
}

// The pictures of a mesh file, each read once.
class Pictures {
public:
    explicit Pictures(const fs::path& file) : file_(file), folder_(file.parent_path()) {}

    std::shared_ptr<const Image> of(const MeshPart& part) {
        if (!part.picture.empty()) {
            const auto same =
                std::find_if(embedded_.begin(), embedded_.end(),
                             [&](const Embedded& other) { return other.bytes == part.picture; });
            if (same != embedded_.end()) {
                return same->picture;
            }
            embedded_.push_back({part.picture, taken("a picture in it", picture_in(part.picture))});
            return embedded_.back().picture;
        }
        if (part.texture.empty()) {
            return nullptr;
        }
        if (const auto found = by_name_.find(part.texture); found != by_name_.end()) {
            return found->second;
        }
        return by_name_[part.texture] = taken(fmt::format("'{}'", part.texture), read(part));
    }

    [[nodiscard]] std::vector<std::string> notes() const {
        return missing_.empty()
                   ? std::vector<std::string>()
                   : std::vector{fmt::format("{}: {}{} cannot be used; a plain colour is shown",
                                             file_.string(), missing_,
                                             more_ > 0 ? fmt::format(" and {} more", more_) : "")};
    }

private:
    [[nodiscard]] Result<Image> read(const MeshPart& part) const {
        const fs::path folder = folder_.empty() ? "." : folder_;
        const fs::path picture = folder / part.texture;
        return is_file_below(folder, picture) ? read_image(picture)
                                              : Result<Image>(Error{"no such file"});
    }

    // Small files may hold large pictures, and a mesh thousands of them.
    std::shared_ptr<const Image> taken(const std::string& what, Result<Image> picture) {
        if (picture && picture->size() <= max_mesh_texels - texels_) {
            texels_ += picture->size();
            return std::make_shared<const Image>(std::move(*picture));
        }
        if (missing_.empty()) {
            missing_ = "the texture " + what;
        } else {
            ++more_;
        }
        return nullptr;
    }

    struct Embedded {
        std::vector<std::byte> bytes;
        std::shared_ptr<const Image> picture;
    };

    fs::path file_;
    fs::path folder_;
    std::vector<Embedded> embedded_;
    std::size_t texels_ = 0;
    std::map<std::string, std::shared_ptr<const Image>> by_name_;
    std::string missing_; // the first
    int more_ = 0;
};

Result<void> check_size(const fs::path& file) {
    std::error_code code;
    if (!fs::is_regular_file(file, code)) {
        return Error{fmt::format("{}: {} found, an OBJ or glTF 2.0 file was expected",
                                 file.string(), kind_of_file(file))};
    }
    const std::uintmax_t size = fs::file_size(file, code);
    if (code || size == 0 || size > max_mesh_bytes) {
        return Error{fmt::format("{}: {} bytes found, a mesh file of 1 byte to {} MB was expected",
                                 file.string(), code ? 0 : size, max_mesh_bytes >> 20U)};
    }
    return {};
}

// Assimp takes a library beside the file, under the file's name, for one that is missing.
bool has_library(const fs::path& file, const std::string& name) {
    const fs::path folder = file.parent_path().empty() ? "." : file.parent_path();
    return is_file_below(folder, folder / name) ||
           is_file_below(folder, fs::path(file).replace_extension(".mtl"));
}

// The notes on an OBJ file; none of other files.
Result<std::vector<std::string>> check_obj(const fs::path& file) {
    std::vector<std::string> notes;
    if (extension_of(file) != ".obj") {
        return notes;
    }
    const auto contents = obj_contents(file);
    if (!contents) {
        return contents.error();
    }
    if (contents->triangles > max_mesh_triangles) {
        return Error{fmt::format("{}: {} triangles found, at most {} were expected", file.string(),
                                 contents->triangles, max_mesh_triangles)};
    }
    if (contents->face_work > max_face_work) {
        return Error{fmt::format("{}: faces of up to {} corners found, which take too long to "
                                 "divide; smaller ones were expected",
                                 file.string(), contents->max_corners)};
    }
    if (contents->material_changes > max_material_changes) {
        return Error{fmt::format("{}: {} changes of the material found, at most {} were expected",
                                 file.string(), contents->material_changes, max_material_changes)};
    }
    std::vector<std::string> missing;
    std::copy_if(contents->libraries.begin(), contents->libraries.end(),
                 std::back_inserter(missing),
                 [&](const std::string& name) { return !has_library(file, name); });
    if (!missing.empty()) {
        notes.push_back(
            fmt::format("{}: the materials '{}'{} cannot be used; plain grey is shown",
                        file.string(), missing.front(),
                        missing.size() > 1 ? fmt::format(" and {} more", missing.size() - 1) : ""));
    }
    return notes;
}

} // namespace

Result<MeshFile> read_mesh_file(const fs::path& file, const ImportLimits& limits,
                                const std::stop_token& stop) {
    if (auto good = check_size(file); !good) {
        return good.error();
    }
    auto notes = check_obj(file);
    if (!notes) {
        return notes.error();
    }
    const auto answer = run_import(file, limits, stop);
    if (!answer) {
        return answer.error();
    }
    auto parts = decoded_parts(*answer);
    if (!parts) {
        return Error{fmt::format("{}: {}", file.string(), parts.error().message)};
    }
    MeshFile found;
    Pictures pictures(file);
    for (MeshPart& part : *parts) {
        if (part.mesh.indices.empty()) {
            continue;
        }
        found.bounds.add(scene::bounds_of(part.mesh));
        auto picture = pictures.of(part);
        found.parts.push_back({std::make_shared<const scene::Mesh>(std::move(part.mesh)),
                               part.color, std::move(picture)});
    }
    found.notes = std::move(*notes);
    const auto of_pictures = pictures.notes();
    found.notes.insert(found.notes.end(), of_pictures.begin(), of_pictures.end());
    if (found.parts.empty()) {
        return Error{fmt::format("{}: no triangle found, some were expected", file.string())};
    }
    return found;
}

} // namespace reljef::io
