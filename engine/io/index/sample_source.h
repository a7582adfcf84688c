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

/// The samples of a window of the closed raster. Outside of it, its border repeats; on a globe, the
/// columns beyond the seam are those of its other side.
class SampleWindow {
public:
    /// Metres; NaN: void. Row 0 is the window's first.
    void copy_row(int row, std::span<float> heights) const;
    [[nodiscard]] const std::vector<FileError>& errors() const { return errors_; }
    [[nodiscard]] std::size_t bytes_read() const { return bytes_read_; }

private:
    friend class SampleSource;
    friend SampleWindow read_sample_window(const IndexSource& source, glm::ivec2 first,
                                           glm::ivec2 size, const std::stop_token& stop);

    /// Columns that are neighbours in the file.
    struct Part {
        int at = 0;          // column of the window
        glm::ivec2 first{0}; // sample of the source
        glm::ivec2 size{0};
        Grid<double> heights = {};
        // Read as they are stored: values, or heights.
        std::unique_ptr<std::uint16_t[]> codes = {};
        std::shared_ptr<const std::vector<float>> height_of_code = {};
        std::unique_ptr<float[]> floats = {};

        void copy_row(int row, std::span<float> into) const;
    };
    /// Without samples.
    SampleWindow(const IndexSource& source, glm::ivec2 first, glm::ivec2 size);
    /// Reads a part through TileSet::read.
    void read(const IndexSource& source, Part& part, const std::stop_token& stop);

    std::vector<Part> parts_;
    int first_row_;                      // of the closed raster
    int rows_before_;                    // above the parts, of the closed raster
    int last_row_;                       // of the closed raster
    std::optional<float> north_, south_; // added poles, metres
    std::vector<FileError> errors_;
    std::size_t bytes_read_ = 0;
};

/// Reads a window through TileSet::read.
SampleWindow read_sample_window(const IndexSource& source, glm::ivec2 first, glm::ivec2 size,
                                const std::stop_token& stop = {});

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
    bool read_direct(SampleWindow::Part& part, const std::stop_token& stop) const;

    const IndexSource& source_;
    mutable std::mutex mutex_; // of the dataset
    std::optional<Direct> direct_;
};

} // namespace reljef::io
