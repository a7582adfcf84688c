#include <algorithm>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include "engine/io/codec/picture_codec.h"
#include "engine/io/codec/tiff_handlers.h"

namespace reljef::io {
namespace {

OIIO::TypeDesc type_of(SampleType type) {
    return type == SampleType::uint8    ? OIIO::TypeDesc::UINT8
           : type == SampleType::uint16 ? OIIO::TypeDesc::UINT16
                                        : OIIO::TypeDesc::FLOAT;
}

PictureHeader header_of(const OIIO::ImageSpec& spec) {
    PictureHeader header;
    header.cols = spec.width;
    header.rows = spec.height;
    header.depth = spec.depth;
    header.tile_cols = spec.tile_width;
    header.tile_rows = spec.tile_height;
    header.tile_depth = spec.tile_depth;
    header.channel_bits = static_cast<int>(8 * spec.format.basesize());
    header.has_floats = spec.format.is_floating_point();
    header.pixel_bytes = static_cast<double>(spec.pixel_bytes(true));
    header.channel_names = spec.channelnames;
    header.channel_names.resize(static_cast<std::size_t>(std::max(spec.nchannels, 0)));
    for (int channel = 0; channel < spec.nchannels; ++channel) {
        header.has_float32.push_back(spec.channelformat(channel) ==
                                     OIIO::TypeDesc(OIIO::TypeDesc::FLOAT));
    }
    return header;
}

OIIO::ImageSpec spec_of(const PictureSpec& picture) {
    OIIO::ImageSpec spec(picture.cols, picture.rows, picture.channels, type_of(picture.type));
    if (!picture.channel_names.empty()) {
        spec.channelnames = picture.channel_names;
    }
    if (picture.has_unassociated_alpha) {
        spec.attribute("oiio:UnassociatedAlpha", 1);
    }
    for (const auto& [name, text] : picture.texts) {
        spec.attribute(name, text);
    }
    return spec;
}

class Input : public PictureInput {
public:
    explicit Input(std::unique_ptr<OIIO::ImageInput> input)
        : input_(std::move(input)), header_(header_of(input_->spec())) {}

    [[nodiscard]] const PictureHeader& header() const override { return header_; }
    // OpenImageIO 2.4 divides by zero where it reads scanlines of a TIFF with tiles.
    bool read_rows(int first_row, int channels, std::span<float> values) override {
        const OIIO::ImageSpec& spec = input_->spec();
        const std::size_t row_values =
            static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(channels);
        const int begin = spec.y + first_row;
        const int end = begin + static_cast<int>(values.size() / row_values);
        return spec.tile_width > 0 ? input_->read_tiles(0, 0, spec.x, spec.x + spec.width, begin,
                                                        end, spec.z, spec.z + 1, 0, channels,
                                                        OIIO::TypeDesc::FLOAT, values.data())
                                   : input_->read_scanlines(0, 0, begin, end, 0, 0, channels,
                                                            OIIO::TypeDesc::FLOAT, values.data());
    }
    bool read_channels(int first, int end, float* values, std::size_t stride) override {
        return input_->read_image(0, 0, first, end, OIIO::TypeDesc::FLOAT, values,
                                  static_cast<OIIO::stride_t>(stride));
    }
    std::string error() override { return input_->geterror(); }

private:
    std::unique_ptr<OIIO::ImageInput> input_;
    PictureHeader header_;
};

class Output : public PictureOutput {
public:
    explicit Output(std::unique_ptr<OIIO::ImageOutput> output) : output_(std::move(output)) {}

    [[nodiscard]] std::string_view format() const override { return output_->format_name(); }
    [[nodiscard]] bool writes_to_memory() const override {
        return output_->supports("ioproxy") != 0;
    }
    std::optional<std::vector<std::byte>> encode(const PictureSpec& spec,
                                                 PicturePixels pixels) override {
        std::vector<unsigned char> memory;
        OIIO::Filesystem::IOVecOutput proxy(memory);
        if (!output_->set_ioproxy(&proxy) || !write(spec, pixels, output_->format_name())) {
            return std::nullopt;
        }
        output_.reset(); // flushes
        const auto all = std::as_bytes(std::span(memory));
        return std::vector<std::byte>(all.begin(), all.end());
    }
    bool encode_file(const PictureSpec& spec, PicturePixels pixels,
                     const std::string& file) override {
        if (!write(spec, pixels, file)) {
            return false;
        }
        output_.reset();
        return true;
    }
    std::string error() override { return output_ != nullptr ? output_->geterror() : ""; }

private:
    bool write(const PictureSpec& picture, PicturePixels pixels, const std::string& name) {
        const OIIO::ImageSpec spec = spec_of(picture);
        return output_->open(name, spec) &&
               output_->write_image(spec.format, pixels.first,
                                    static_cast<OIIO::stride_t>(pixels.stride)) &&
               output_->close();
    }

    std::unique_ptr<OIIO::ImageOutput> output_;
};

class Codec : public PictureCodec {
public:
    OpenedPicture open(const std::string& format, const std::string& file) override {
        auto input = OIIO::ImageInput::create(format);
        OIIO::ImageSpec desired;
        desired.attribute("oiio:UnassociatedAlpha", 1);
        OIIO::ImageSpec found;
        if (input == nullptr || !input->open(file, found, desired)) {
            return {nullptr, input == nullptr ? OIIO::geterror() : input->geterror()};
        }
        return {std::make_unique<Input>(std::move(input)), {}};
    }
    std::unique_ptr<PictureOutput> create_output(const std::string& name) override {
        auto output = OIIO::ImageOutput::create(name);
        static_cast<void>(OIIO::geterror());
        return output != nullptr ? std::make_unique<Output>(std::move(output)) : nullptr;
    }
    void resize(const PictureArea& from, const PictureArea& to) override {
        const OIIO::ImageBuf source({from.cols, from.rows, 4, OIIO::TypeDesc::UINT8}, from.pixels);
        OIIO::ImageBuf target({to.cols, to.rows, 4, OIIO::TypeDesc::UINT8}, to.pixels);
        OIIO::ImageBufAlgo::resize(target, source);
    }
};

} // namespace
} // namespace reljef::io

extern "C" [[gnu::visibility("default")]] const reljef::io::PictureModule* reljef_picture_module();

const reljef::io::PictureModule* reljef_picture_module() {
    static reljef::io::Codec codec;
    static const reljef::io::PictureModule module = [] {
        // OpenImageIO makes a reader of each format once, and that of TIFF installs handlers.
        reljef::io::keep_tiff_handlers([] {
            static_cast<void>(OIIO::ImageInput::create("a.tif"));
            static_cast<void>(OIIO::ImageOutput::create("a.tif"));
        });
        return reljef::io::PictureModule{RELJEF_PICTURE_INTERFACE, &codec};
    }();
    return &module;
}
