#include "engine/io/image/png_stream.h"

#include <array>
#include <csetjmp>
#include <exception>
#include <utility>

#include <png.h>

namespace reljef::io {

// libpng returns from errors by longjmp(): between setjmp() and its calls, nothing has a
// destructor.
struct PngStream::State {
    State(glm::ivec2 sides, Sink taker) : size(sides), sink(std::move(taker)) {
        png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &State::fail, &State::ignore);
        info = png != nullptr ? png_create_info_struct(png) : nullptr;
        if (info != nullptr) {
            png_set_write_fn(png, this, &State::take, nullptr);
        } else {
            error = "no memory";
        }
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() { png_destroy_write_struct(&png, &info); }

    static void fail(png_structp png, png_const_charp text) {
        static_cast<State*>(png_get_error_ptr(png))->keep(text);
        png_longjmp(png, 1);
    }
    static void ignore(png_structp /*png*/, png_const_charp /*warning*/) {}
    static void take(png_structp png, png_bytep bytes, std::size_t count) {
        if (!static_cast<State*>(png_get_io_ptr(png))->put(bytes, count)) {
            png_longjmp(png, 1);
        }
    }
    bool put(png_const_bytep bytes, std::size_t count) {
        try {
            if (sink({reinterpret_cast<const std::byte*>(bytes), count})) {
                return true;
            }
            keep("its file cannot be written");
        } catch (const std::exception& problem) {
            keep(problem.what());
        }
        return false;
    }
    void keep(const char* text) {
        try {
            error = text;
        } catch (const std::exception&) {
            error.clear();
        }
    }

    void begin() {
        constexpr int compression_level = 6;
        std::array<char, 16> key{"oiio:ColorSpace"};
        std::array<char, 5> value{"sRGB"};
        png_text text{};
        text.compression = PNG_TEXT_COMPRESSION_NONE;
        text.key = key.data();
        text.text = value.data();
        png_set_compression_level(png, compression_level);
        png_set_compression_strategy(png, 0); // zlib's default, not libpng's
        png_set_IHDR(png, info, static_cast<png_uint_32>(size.x), static_cast<png_uint_32>(size.y),
                     8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
        png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
        png_set_text(png, info, &text, 1);
        png_write_info(png, info);
        png_set_filler(png, 0, PNG_FILLER_AFTER); // no alpha is written
        has_begun = true;
    }

    glm::ivec2 size;
    Sink sink;
    std::string error;
    png_structp png = nullptr;
    png_infop info = nullptr;
    bool has_begun = false;
};

PngStream::PngStream(glm::ivec2 size, Sink sink)
    : state_(std::make_unique<State>(size, std::move(sink))) {}
PngStream::~PngStream() = default;

bool PngStream::write(const Image& rows) {
    State& state = *state_;
    if (state.info == nullptr || setjmp(png_jmpbuf(state.png)) != 0) {
        return false;
    }
    if (!state.has_begun) {
        state.begin();
    }
    for (int row = 0; row < rows.rows(); ++row) {
        png_write_row(state.png, reinterpret_cast<png_const_bytep>(rows.row(row).data()));
    }
    return true;
}

bool PngStream::end() {
    State& state = *state_;
    if (state.info == nullptr || setjmp(png_jmpbuf(state.png)) != 0) {
        return false;
    }
    png_write_end(state.png, state.info);
    return true;
}

const std::string& PngStream::error() const {
    return state_->error;
}

} // namespace reljef::io
