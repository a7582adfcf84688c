#include "app/rendering/frame_sink.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "app/rendering/video_encoder.h"
#include "engine/io/image/image.h"

namespace reljef::app {
namespace {

namespace fs = std::filesystem;

class PictureSink : public FrameSink {
public:
    explicit PictureSink(fs::path name) : name_(std::move(name)) {}
    Result<void> write(const Image& picture, int /*index*/) override {
        auto file = io::prepare_image(name_, picture);
        if (!file) {
            return file.error();
        }
        file_ = std::move(*file);
        return {};
    }
    Result<void> finish(std::vector<AtomicFile>& outputs) override {
        if (file_) {
            outputs.push_back(*std::exchange(file_, std::nullopt));
        }
        return {};
    }

private:
    fs::path name_;
    std::optional<AtomicFile> file_;
};

// Encodes, writes and syncs a picture while the next one is drawn.
class NumberedSink : public FrameSink {
public:
    explicit NumberedSink(fs::path name) : name_(std::move(name)) {}
    Result<void> write(const Image& picture, int index) override {
        auto file = numbered(name_, index);
        auto before = file ? wait() : file.error();
        if (before) {
            written_ = std::async(std::launch::async, [file = *std::move(file), picture] {
                return io::write_image(file, picture);
            });
        }
        return before;
    }
    Result<void> finish(std::vector<AtomicFile>& /*outputs*/) override { return wait(); }

private:
    Result<void> wait() { return written_.valid() ? written_.get() : Result<void>(); }

    fs::path name_;
    std::future<Result<void>> written_; // of the last picture
};

class StandardOutputSink : public FrameSink {
public:
    Result<void> write(const Image& picture, int /*index*/) override {
        const auto bytes = io::encode_image(".png", picture);
        if (!bytes) {
            return bytes.error();
        }
        if (std::fwrite(bytes->data(), 1, bytes->size(), stdout) != bytes->size() ||
            std::fflush(stdout) != 0) {
            return Error{
                fmt::format("standard output: cannot be written: {}", std::strerror(errno))};
        }
        return {};
    }
    Result<void> finish(std::vector<AtomicFile>& /*outputs*/) override { return {}; }
};

Result<void> make_folder(const fs::path& pattern) {
    const auto first = numbered(pattern, 0);
    if (!first) {
        return first.error();
    }
    if (!first->has_parent_path()) {
        return {};
    }
    std::error_code code;
    fs::create_directories(first->parent_path(), code);
    if (code) {
        return Error{fmt::format("{}: the folder cannot be made: {}", first->parent_path().string(),
                                 code.message())};
    }
    return {};
}

} // namespace

bool is_standard_output(const fs::path& output) {
    return output == "-";
}

Result<void> check_standard_output(std::string_view other) {
    if (!other.empty()) {
        return Error{fmt::format("-o: - found beside {}, which writes to standard output, too; a "
                                 "file was expected",
                                 other)};
    }
    if (::isatty(STDOUT_FILENO) == 1) {
        return Error{"-o: - found, and standard output is a terminal; a pipe or a file was "
                     "expected"};
    }
    return {};
}

bool is_numbered(const fs::path& output) {
    return output.string().find('%') != std::string::npos;
}

Result<void> check_output_name(const fs::path& output, int frames) {
    const auto wrong_name = [&](std::string_view expected) {
        return Error{fmt::format("-o: '{}' found, {} was expected", output.string(), expected)};
    };
    if (is_numbered(output)) {
        if (const auto first = numbered(output, 0); !first) {
            return first.error();
        }
        if (is_video(output)) {
            return wrong_name("a video's name without a number");
        }
        if (!is_numbered(output.filename())) {
            return wrong_name("a number in the file's name, not in the folder's");
        }
    } else if (frames > 1 && !is_video(output)) {
        return wrong_name(
            fmt::format("a numbered name like %04d.png or a video for {} frames", frames));
    }
    return is_video(output) || is_standard_output(output) ? Result<void>()
                                                          : io::check_image_name(output);
}

bool is_video(const fs::path& path) {
    constexpr std::array extensions{".mp4", ".mkv", ".webm", ".mov"};
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

Result<fs::path> numbered(const fs::path& pattern, int index) {
    constexpr std::size_t none = std::string::npos;
    constexpr int max_width = 12;
    const std::string text = pattern.string();
    const std::size_t percent = text.find('%');
    const std::size_t begin = percent != none ? text.find_first_not_of('0', percent + 1) : none;
    const std::size_t end = begin != none ? text.find_first_not_of("0123456789", begin) : none;
    int width = 0; // stays 0 where there is none
    if (end != none && end - begin <= 2) {
        std::from_chars(text.data() + begin, text.data() + end, width);
    } else {
        width = max_width + 1;
    }
    if (width > max_width || text[end] != 'd' || text.find('%', end) != none) {
        return Error{fmt::format("-o: '{}' found, one number like %04d was expected in it", text)};
    }
    return fs::path(
        fmt::format("{}{:0{}}{}", text.substr(0, percent), index, width, text.substr(end + 1)));
}

Result<std::unique_ptr<FrameSink>> make_frame_sink(const fs::path& output,
                                                   const FrameSinkOptions& options) {
    using Sink = std::unique_ptr<FrameSink>;
    if (auto named = check_output_name(output, options.frames); !named) {
        return named.error();
    }
    if (is_video(output)) {
        remove_leftovers(output.parent_path());
        auto encoder = VideoEncoder::create(output, options.size, options.frames_per_second);
        return encoder ? Result<Sink>(std::make_unique<VideoEncoder>(std::move(*encoder)))
                       : encoder.error();
    }
    if (is_standard_output(output)) {
        return Sink(new StandardOutputSink);
    }
    if (is_numbered(output)) {
        if (auto made = make_folder(output); !made) {
            return made.error();
        }
        remove_leftovers(output.parent_path());
        return Sink(new NumberedSink(output));
    }
    return Sink(new PictureSink(output));
}

namespace {

constexpr int sheet_columns = 4;
constexpr int sheet_picture_width = 320;
constexpr int max_sheet_pictures = 24;

} // namespace

SheetPictures::SheetPictures(bool is_requested, int frames)
    : step_(is_requested ? (frames + max_sheet_pictures - 1) / max_sheet_pictures : 0) {}

void SheetPictures::add(Image picture, int index) {
    if (step_ > 0 && index % step_ == 0) {
        pictures_.push_back(std::move(picture));
    }
}

Result<void> SheetPictures::prepare(const std::filesystem::path& file,
                                    std::vector<AtomicFile>& outputs) const {
    if (pictures_.empty()) {
        return {};
    }
    const auto sheet = io::contact_sheet(pictures_, sheet_columns, sheet_picture_width);
    if (!sheet) {
        return sheet.error();
    }
    auto prepared = io::prepare_image(file, *sheet);
    if (!prepared) {
        return prepared.error();
    }
    outputs.push_back(std::move(*prepared));
    return {};
}

} // namespace reljef::app
