#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "engine/io/index/error_index.h"
#include "engine/io/raster/gdal_dataset.h"
#include "engine/io/raster/sample_decoder.h"

namespace reljef::io {

/// The samples of a window; outside the raster its border repeats.
class SampleWindow {
public:
    /// Metres; NaN: void. Row 0 is the window's first.
    void copy_row(int row, std::span<float> heights) const;
    [[nodiscard]] const std::vector<FileError>& errors() const { return errors_; }

private:
    friend class SampleSource;

    glm::ivec2 before_{0}; // columns and rows outside the raster at its start
    glm::ivec2 size_{0};   // inside
    Grid<double> heights_;
    // Read as they are stored: values, or heights.
    std::unique_ptr<std::uint16_t[]> codes_;
    std::shared_ptr<const std::vector<float>> height_of_code_;
    std::unique_ptr<float[]> floats_;
    std::vector<FileError> errors_;
};

/// Reads the samples of a terrain in large windows. A file of 8-bit, 16-bit or float values
/// is read block by block, all others through TileSet::read. Thread-safe.
class SampleSource {
public:
    explicit SampleSource(const IndexSource& source);

    [[nodiscard]] SampleWindow read(glm::ivec2 first, glm::ivec2 size,
                                    const std::stop_token& stop) const;

private:
    struct Direct {
        Dataset dataset;
        glm::ivec2 first_pixel{0};
        SampleDecoder decoder;
        GDALDataType type = GDT_Int16;
        std::shared_ptr<const std::vector<float>> height_of_code = {}; // of whole numbers
        std::vector<std::uint16_t> contextual_codes =
            {}; // whether a void depends on the whole file
    };
    static std::optional<Direct> open_direct(const IndexSource& source);
    static void add_codes(Direct& direct);
    bool read_stored(glm::ivec2 first, glm::ivec2 size, void* values,
                     const std::stop_token& stop) const;
    bool read_direct(glm::ivec2 first, SampleWindow& window, const std::stop_token& stop) const;

    const IndexSource& source_;
    mutable std::mutex mutex_; // of the dataset
    std::optional<Direct> direct_;
};

} // namespace reljef::io
