#include "engine/io/mesh/import_files.h"

#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <assimp/IOStream.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <fmt/format.h>

#include "engine/io/mesh/mesh_import.h"
#include "engine/io/mesh/near_file.h"

namespace reljef::io {
namespace {

// Makes comments of an OBJ file's lines with groups, objects, lines and points: Assimp takes over
// 20 s for 50,000 groups, and reljef needs faces and materials only.
class FacesOnly : public Assimp::IOStream {
public:
    explicit FacesOnly(std::unique_ptr<Assimp::IOStream> file) : file_(std::move(file)) {}

    std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
        constexpr std::string_view left_out = "golp";
        const std::size_t items = file_->Read(buffer, size, count);
        auto* const bytes = static_cast<char*>(buffer);
        for (std::size_t i = 0; i < items * size; ++i) {
            char& c = bytes[i];
            const bool is_continued = before_ == '\\';
            if (before_ == '\n' && left_out.find(c) != std::string_view::npos) {
                c = '#';
            }
            before_ = is_continued && c == '\n' ? ' ' : is_continued && c == '\r' ? '\\' : c;
        }
        return items;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t place = file_->Tell();
        const aiReturn done = file_->Seek(offset, origin);
        if (file_->Tell() != place) {
            before_ = file_->Tell() == 0 ? '\n' : ' ';
        }
        return done;
    }
    [[nodiscard]] std::size_t Tell() const override { return file_->Tell(); }
    [[nodiscard]] std::size_t FileSize() const override { return file_->FileSize(); }
    void Flush() override {}

private:
    std::unique_ptr<Assimp::IOStream> file_;
    char before_ = '\n'; // what the next character follows
};

Assimp::IOStream* stream_of(std::string_view text) {
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text.data()),
                                      text.size());
}

// Counts the lines that Assimp takes for the begin of a material: "ne" in any case after blanks.
// Zeros are left out: a library may have 16 bits for each character.
class MaterialLines {
public:
    void take(char c) {
        if (c == '\0' || (before_ == '\n' && (c == ' ' || c == '\t'))) {
            return;
        }
        count_ += static_cast<std::size_t>(before_ == 'n' && c == 'e');
        const bool is_first = before_ == '\n' && (c == 'n' || c == 'N');
        before_ = c == '\n' || c == '\r' ? '\n' : is_first ? 'n' : ' ';
    }
    [[nodiscard]] std::size_t count() const { return count_; }

private:
    std::size_t count_ = 0;
    char before_ = '\n'; // a line's begin, its first letter, or a blank for the rest of it
};

std::size_t materials_in(const std::filesystem::path& library) {
    std::ifstream stream(library, std::ios::binary);
    std::vector<char> block(std::size_t{1} << 16U);
    MaterialLines lines;
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        for (const char c :
             std::string_view(block.data(), static_cast<std::size_t>(stream.gcount()))) {
            lines.take(c);
        }
    }
    return lines.count();
}

} // namespace

ImportFiles::ImportFiles(std::filesystem::path file, std::string contents)
    : file_(std::move(file)), folder_(file_.parent_path()), contents_(std::move(contents)),
      is_obj_(extension_of(file_) == ".obj"), left_(max_mesh_bytes) {}

bool ImportFiles::Exists(const char* name) const {
    return is_file_below(folder_, name) && DefaultIOSystem::Exists(name);
}

Assimp::IOStream* ImportFiles::Open(const char* name, const char* mode) {
    if (!is_file_below(folder_, name) || std::strchr(mode, 'w') != nullptr) {
        return nullptr;
    }
    std::error_code code;
    const std::uintmax_t openings = ++openings_[std::filesystem::canonical(name, code)];
    const std::uintmax_t size = openings == 1 ? std::filesystem::file_size(name, code) : 0;
    if (code || size > left_) {
        return nullptr;
    }
    left_ -= size;
    if (!contents_.empty() && file_ == name) {
        return stream_of(contents_);
    }
    if (!is_obj_) {
        return DefaultIOSystem::Open(name, mode);
    }
    // Also the OBJ itself, because it may name itself as a library.
    if (openings == 1 && !add_materials(name)) {
        return nullptr;
    }
    constexpr std::uintmax_t looks = 4; // of Assimp at a file's begin, size and contents
    if (openings > (file_ == name ? looks : 1)) {
        return stream_of("# was read before\n");
    }
    std::unique_ptr<Assimp::IOStream> file(DefaultIOSystem::Open(name, mode));
    return file != nullptr && file_ == name ? new FacesOnly(std::move(file)) : file.release();
}

bool ImportFiles::add_materials(const std::filesystem::path& file) {
    materials_ += materials_in(file);
    if (materials_ > max_library_materials) {
        problem_ = fmt::format("{} materials found, at most {} were expected", materials_,
                               max_library_materials);
    }
    return problem_.empty();
}

} // namespace reljef::io
