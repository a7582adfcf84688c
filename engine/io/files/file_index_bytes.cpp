#include <algorithm>
#include <cstring>
#include <set>

#include "engine/io/cache/fnv_hash.h"
#include "engine/io/files/file_index.h"
#include "engine/io/raster/georeferencing.h"
#include "engine/terrain/tree/tile_tree.h"

namespace reljef::io {
namespace {

constexpr std::string_view index_magic = "reljef tile index 2\n";
constexpr std::size_t checksum_bytes = 8;

class IndexWriter {
public:
    template <class T> void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    }
    void put(const std::string& text) {
        put(static_cast<std::uint32_t>(text.size()));
        bytes_ += text;
    }
    [[nodiscard]] std::string bytes() && { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Past the end all values are 0 and good() is false.
class IndexReader {
public:
    explicit IndexReader(std::string_view bytes) : rest_(bytes) {}

    template <class T> void get(T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (const std::string_view raw = take(sizeof(T)); !raw.empty()) {
            std::memcpy(&value, raw.data(), sizeof(T));
        }
    }
    void get(std::string& text) {
        std::uint32_t size = 0;
        get(size);
        text = std::string(take(size));
    }
    // A bool or an enumerator of any other value would be undefined behaviour.
    void get(bool& flag) { flag = limited(1) == 1; }
    void get(FileKind& kind) {
        kind = static_cast<FileKind>(limited(static_cast<std::uint8_t>(FileKind::error)));
    }
    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] bool at_end() const { return good_ && rest_.empty(); }

private:
    std::uint8_t limited(std::uint8_t max) {
        std::uint8_t value = 0;
        get(value);
        good_ = good_ && value <= max;
        return good_ ? value : std::uint8_t{0};
    }
    std::string_view take(std::size_t count) {
        if (!good_ || rest_.size() < count) {
            good_ = false;
            return {};
        }
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }

    std::string_view rest_;
    bool good_ = true;
};

/// Visits each field, for reading and writing.
template <class File, class Visit> void visit_fields(File& file, const Visit& visit) {
    const auto visit_all = [&](auto&... fields) { (visit(fields), ...); };
    visit_all(file.path, file.bytes, file.modified, file.sidecar_hash, file.opened, file.use,
              file.error, file.cols, file.rows, file.crs_from_pixel, file.crs, file.format,
              file.type, file.vertical_datum, file.declares_voids);
}

bool is_usable_file(const IndexedFile& file, std::size_t systems) {
    return file.opened && file.error.empty() && file.crs >= 0 &&
           static_cast<std::size_t>(file.crs) < systems && std::min(file.cols, file.rows) >= 2 &&
           std::max(file.cols, file.rows) <= terrain::max_tree_samples &&
           is_usable(file.crs_from_pixel);
}

bool is_consistent(const FileIndex& index) {
    const std::set<std::string_view> systems(index.crs.begin(), index.crs.end());
    const auto is_out_of_order = [](const IndexedFile& a, const IndexedFile& b) {
        return a.path >= b.path;
    };
    return systems.size() == index.crs.size() && !systems.contains("") &&
           std::adjacent_find(index.files.begin(), index.files.end(), is_out_of_order) ==
               index.files.end() &&
           std::all_of(index.files.begin(), index.files.end(), [&](const IndexedFile& file) {
               return !file.path.empty() && std::min(file.cols, file.rows) >= 0 &&
                      (file.use != FileKind::heights || is_usable_file(file, index.crs.size()));
           });
}

} // namespace

std::string bytes_of(const FileIndex& index) {
    IndexWriter writer;
    writer.put(static_cast<std::uint32_t>(index.crs.size()));
    for (const std::string& crs : index.crs) {
        writer.put(crs);
    }
    writer.put(static_cast<std::uint32_t>(index.files.size()));
    for (const IndexedFile& file : index.files) {
        visit_fields(file, [&](const auto& field) { writer.put(field); });
    }
    const std::string content = std::move(writer).bytes();
    IndexWriter head;
    head.put(fnv_hash(content));
    return std::string(index_magic) + std::move(head).bytes() + content;
}

Result<FileIndex> index_from_bytes(std::string_view bytes) {
    if (!bytes.starts_with(index_magic)) {
        return Error{"is of another version"};
    }
    bytes.remove_prefix(index_magic.size());
    std::uint64_t checksum = 0;
    IndexReader(bytes).get(checksum);
    bytes.remove_prefix(std::min(checksum_bytes, bytes.size()));
    if (fnv_hash(bytes) != checksum) {
        return Error{"is cut or was changed"};
    }
    IndexReader reader(bytes);
    FileIndex index;
    std::uint32_t count = 0;
    reader.get(count);
    for (std::uint32_t i = 0; i < count && reader.good(); ++i) {
        reader.get(index.crs.emplace_back());
    }
    reader.get(count);
    for (std::uint32_t i = 0; i < count && reader.good(); ++i) {
        visit_fields(index.files.emplace_back(), [&](auto& field) { reader.get(field); });
    }
    if (!reader.at_end() || !is_consistent(index)) {
        return Error{"is cut or was changed"};
    }
    return index;
}

} // namespace reljef::io
