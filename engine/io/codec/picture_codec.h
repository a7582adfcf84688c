#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// What programs and the module with OpenImageIO share: both compile this header, so it names
// nothing of OpenImageIO. The functions throw what OpenImageIO throws.
namespace reljef::io {

/// A picture's header. Sides in pixels.
struct PictureHeader {
    int cols = 0;
    int rows = 0;
    int depth = 1;
    int tile_cols = 0; ///< 0: stored in rows
    int tile_rows = 0;
    int tile_depth = 0;
    int channel_bits = 0;     ///< of the widest channel
    bool has_floats = false;  ///< in that channel
    double pixel_bytes = 0.0; ///< as stored
    std::vector<std::string> channel_names;
    std::vector<bool> has_float32; ///< by channel

    [[nodiscard]] int channels() const { return static_cast<int>(channel_names.size()); }
};

/// An open picture. Integer values are scaled to [0,1]; floats are unchanged. Alpha is not
/// associated.
class PictureInput {
public:
    PictureInput() = default;
    PictureInput(const PictureInput&) = delete;
    PictureInput& operator=(const PictureInput&) = delete;
    virtual ~PictureInput() = default;

    [[nodiscard]] virtual const PictureHeader& header() const = 0;
    /// The first `channels` channels of whole rows from `first_row` on, of as many as fit the
    /// values. Precondition: in a picture with tiles, a row of tiles begins there.
    virtual bool read_rows(int first_row, int channels, std::span<float> values) = 0;
    /// Some channels of the whole picture, pixel by pixel, `stride` bytes from pixel to pixel.
    virtual bool read_channels(int first, int end, float* values, std::size_t stride) = 0;
    /// Why the last call failed.
    virtual std::string error() = 0;
};

enum class SampleType { uint8, uint16, float32 };

/// A picture to write. `texts` are OpenImageIO's attributes and their values.
struct PictureSpec {
    int cols = 0;
    int rows = 0;
    int channels = 0;
    SampleType type = SampleType::uint8;
    bool has_unassociated_alpha = false;
    std::vector<std::pair<std::string, std::string>> texts = {};
    std::vector<std::string> channel_names = {}; ///< empty: R, G, B, A
};

/// Pixels of a PictureSpec's type, `stride` bytes from pixel to pixel, row after row.
struct PicturePixels {
    const void* first = nullptr;
    std::size_t stride = 0;
};

/// An encoder of one picture.
class PictureOutput {
public:
    PictureOutput() = default;
    PictureOutput(const PictureOutput&) = delete;
    PictureOutput& operator=(const PictureOutput&) = delete;
    virtual ~PictureOutput() = default;

    [[nodiscard]] virtual std::string_view format() const = 0;
    /// Whether encode() works; others only write files.
    [[nodiscard]] virtual bool writes_to_memory() const = 0;
    /// The whole picture; absent if it fails. Both end the encoder.
    virtual std::optional<std::vector<std::byte>> encode(const PictureSpec& spec,
                                                         PicturePixels pixels) = 0;
    virtual bool encode_file(const PictureSpec& spec, PicturePixels pixels,
                             const std::string& file) = 0;
    /// Why the last call failed.
    virtual std::string error() = 0;
};

/// RGBA of 8 bits in memory.
struct PictureArea {
    int cols = 0;
    int rows = 0;
    void* pixels = nullptr;
};

struct OpenedPicture {
    std::unique_ptr<PictureInput> input; ///< null: it cannot be opened
    std::string error;                   ///< why
};

/// Thread-safe.
class PictureCodec {
public:
    PictureCodec() = default;
    PictureCodec(const PictureCodec&) = delete;
    PictureCodec& operator=(const PictureCodec&) = delete;
    virtual ~PictureCodec() = default;

    /// A picture of a format that picture_format() names.
    virtual OpenedPicture open(const std::string& format, const std::string& file) = 0;
    /// For a file's extension, or the name of a format; null without one.
    virtual std::unique_ptr<PictureOutput> create_output(const std::string& name) = 0;
    /// Fills `to` with `from`, resampled.
    virtual void resize(const PictureArea& from, const PictureArea& to) = 0;
};

/// What the module exports, under the name in `picture_module_function`.
struct PictureModule {
    const char* interface = nullptr; ///< the checksum of this header that the module was built with
    PictureCodec* codec = nullptr;
};
using PictureModuleFunction = const PictureModule* (*)();
inline constexpr const char* picture_module_function = "reljef_picture_module";

} // namespace reljef::io
