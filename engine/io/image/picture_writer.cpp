#include "engine/io/image/picture_writer.h"

#include <algorithm>
#include <exception>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "engine/core/check.h"
#include "engine/io/checks/lowercase.h"
#include "engine/io/image/png_stream.h"
#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {
namespace fs = std::filesystem;

class PictureWriter::Encoder {
public:
    Encoder(AtomicFile file, glm::ivec2 size) : file_(std::move(file)), size_(size) {}
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    virtual ~Encoder() = default;

    Result<void> write(const Image& rows) {
        check(rows.cols() == size_.x && row_ + rows.rows() <= size_.y, "rows of another picture");
        auto written = write_at(row_, rows);
        row_ += rows.rows();
        return written;
    }
    Result<AtomicFile> finish() {
        check(row_ == size_.y, "a picture with missing rows");
        auto closed = close();
        return closed ? Result<AtomicFile>(std::move(file_)) : closed.error();
    }

protected:
    virtual Result<void> write_at(int row, const Image& rows) = 0;
    virtual Result<void> close() = 0;

    [[nodiscard]] Error error(std::string_view why) const {
        return Error{fmt::format("{}: cannot be written{}{}", file_.target().string(),
                                 why.empty() ? "" : ": ", why)};
    }
    [[nodiscard]] AtomicFile& file() { return file_; }
    [[nodiscard]] const AtomicFile& file() const { return file_; }
    [[nodiscard]] glm::ivec2 size() const { return size_; }

private:
    AtomicFile file_;
    glm::ivec2 size_;
    int row_ = 0; // the next one
};

namespace {

bool is_png(const fs::path& path) {
    return extension_of(path) == ".png";
}

bool is_tiff(const fs::path& path) {
    return extension_of(path) == ".tif" || extension_of(path) == ".tiff";
}

class PngEncoder : public PictureWriter::Encoder {
public:
    PngEncoder(AtomicFile made, glm::ivec2 size)
        : Encoder(std::move(made), size),
          stream_(size, [this](std::span<const std::byte> bytes) { return store(bytes); }) {}

    static Result<void> open() { return {}; }

protected:
    Result<void> write_at(int /*row*/, const Image& rows) override {
        return stream_.write(rows) ? Result<void>() : failure();
    }
    Result<void> close() override { return stream_.end() ? Result<void>() : failure(); }

private:
    bool store(std::span<const std::byte> bytes) {
        stored_ = file().write(bytes);
        return stored_.has_value();
    }
    [[nodiscard]] Error failure() const {
        return stored_ ? error(stream_.error()) : stored_.error();
    }

    Result<void> stored_; // why the file could not be written
    PngStream stream_;
};

// GDAL writes tiles in any order and BigTIFF; OpenImageIO 2.4 writes neither to any size.
class TiffEncoder : public PictureWriter::Encoder {
public:
    using Encoder::Encoder;
    TiffEncoder(const TiffEncoder&) = delete;
    TiffEncoder& operator=(const TiffEncoder&) = delete;
    ~TiffEncoder() override {
        const GdalMessages silent; // of a picture that could not be written
        dataset_.reset();
    }

    Result<void> open() {
        register_drivers();
        const GdalMessages messages;
        CPLStringList options;
        add_options(options,
                    {"TILED=YES", fmt::format("BLOCKXSIZE={}", PictureWriter::tile.x),
                     fmt::format("BLOCKYSIZE={}", PictureWriter::tile.y), "INTERLEAVE=PIXEL",
                     "PHOTOMETRIC=RGB", "COMPRESS=DEFLATE", "PREDICTOR=2", "BIGTIFF=IF_SAFER"});
        dataset_.reset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
            file().temporary().c_str(), size().x, size().y, 3, GDT_Byte, options.List()));
        return dataset_ != nullptr ? Result<void>() : messages.cannot_write(file());
    }

protected:
    Result<void> write_at(int row, const Image& rows) override {
        const GdalMessages messages;
        // GDAL only reads from this pointer.
        auto* const pixels = const_cast<Rgba8*>(rows.samples().data());
        constexpr int pixel_bytes = sizeof(Rgba8);
        const GSpacing row_bytes = GSpacing{pixel_bytes} * rows.cols();
        const bool written = dataset_->RasterIO(GF_Write, 0, row, rows.cols(), rows.rows(), pixels,
                                                rows.cols(), rows.rows(), GDT_Byte, 3, nullptr,
                                                pixel_bytes, row_bytes, 1, nullptr) == CE_None;
        dataset_->FlushCache(false); // keeps no written tiles
        return written && messages.errors() == 0 ? Result<void>() : messages.cannot_write(file());
    }
    Result<void> close() override {
        const GdalMessages messages;
        dataset_.reset(); // flushes
        return messages.errors() == 0 ? Result<void>() : messages.cannot_write(file());
    }

private:
    Dataset dataset_;
};

template <class Encoder>
Result<std::unique_ptr<PictureWriter::Encoder>> opened(AtomicFile file, glm::ivec2 size) {
    using Opened = Result<std::unique_ptr<PictureWriter::Encoder>>;
    auto encoder = std::make_unique<Encoder>(std::move(file), size);
    const auto open = encoder->open();
    return open ? Opened(std::move(encoder)) : open.error();
}

// libpng's limit, PNG_USER_WIDTH_MAX: programs read no larger ones.
constexpr int max_png_side = 1'000'000;
// GDAL numbers the tiles of a TIFF by 31 bits, as their sum over all bands.
constexpr double max_tiff_tiles = 0x1p31 / 3;

Result<void> check_size(const fs::path& path, glm::ivec2 size) {
    const auto too_large = [&](std::string_view expected) {
        return Error{fmt::format("{}: {}x{} pixels found, {} was expected", path.string(), size.x,
                                 size.y, expected)};
    };
    if (is_png(path) && std::max(size.x, size.y) > max_png_side) {
        return too_large(fmt::format("a PNG of at most {} a side", max_png_side));
    }
    const glm::dvec2 tiles = glm::ceil(glm::dvec2(size) / glm::dvec2(PictureWriter::tile));
    if (is_tiff(path) && tiles.x * tiles.y > max_tiff_tiles) {
        return too_large("a TIFF of fewer tiles");
    }
    return {};
}

} // namespace

bool is_written_in_bands(const fs::path& path) {
    return is_png(path) || is_tiff(path);
}

PictureWriter::PictureWriter(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
PictureWriter::PictureWriter(PictureWriter&& other) noexcept = default;
PictureWriter& PictureWriter::operator=(PictureWriter&& other) noexcept = default;
PictureWriter::~PictureWriter() = default;

Result<PictureWriter> PictureWriter::create(const fs::path& path, glm::ivec2 size) {
    check(size.x > 0 && size.y > 0, "a picture without pixels");
    if (!is_written_in_bands(path)) {
        return Error{fmt::format("{}: {:?} found, .png or .tif was expected for a picture of {}x{} "
                                 "pixels",
                                 path.string(), path.extension().string(), size.x, size.y)};
    }
    if (auto sized = check_size(path, size); !sized) {
        return sized.error();
    }
    auto file = AtomicFile::create(path);
    if (!file) {
        return file.error();
    }
    auto encoder = is_png(path) ? opened<PngEncoder>(std::move(*file), size)
                                : opened<TiffEncoder>(std::move(*file), size);
    return encoder ? Result<PictureWriter>(PictureWriter(std::move(*encoder))) : encoder.error();
}

Result<void> PictureWriter::write(const Image& rows) {
    return encoder_->write(rows);
}

Result<AtomicFile> PictureWriter::finish() {
    return encoder_->finish();
}

} // namespace reljef::io
