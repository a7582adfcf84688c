#include "app/rendering/video_encoder.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace reljef::app {
namespace {

std::vector<std::string> arguments_for(const std::filesystem::path& file, glm::ivec2 size,
                                       double frames_per_second) {
    return {"ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgba",
            "-video_size", fmt::format("{}x{}", size.x, size.y), "-framerate",
            fmt::format("{}", frames_per_second), "-i", "-",
            // Most players need even sides and 4:2:0.
            "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p",
            // Never an option, a protocol ("pipe:") or another program's syntax.
            "file:" + file.string()};
}

Result<pid_t> start(const std::vector<std::string>& arguments, int input, int messages) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
    pid_t process = -1;
    const int code = posix_spawnp(&process, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (code != 0) {
        return Error{
            "ffmpeg was not found, which videos need; install it (apt-get install ffmpeg) or "
            "write numbered pictures (-o 'frames/%04d.png')"};
    }
    return process;
}

} // namespace

Result<VideoEncoder> VideoEncoder::create(const std::filesystem::path& file, glm::ivec2 size,
                                          double frames_per_second) {
    auto output = AtomicFile::create(file);
    if (!output) {
        return output.error();
    }
    auto messages = MemoryFile::create();
    if (!messages) {
        return Error{fmt::format("{}: {}", file.string(), messages.error().message)};
    }
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return Error{fmt::format("{}: no pipe to ffmpeg: {}", file.string(), std::strerror(errno))};
    }
    auto process = start(arguments_for(output->temporary(), size, frames_per_second), ends[0],
                         messages->descriptor());
    ::close(ends[0]);
    if (!process) {
        ::close(ends[1]);
        return Error{fmt::format("{}: {}", file.string(), process.error().message)};
    }
    return VideoEncoder(std::move(*output), std::move(*messages), *process, ends[1]);
}

VideoEncoder::VideoEncoder(VideoEncoder&& other) noexcept
    : file_(std::move(other.file_)), messages_(std::move(other.messages_)),
      process_(std::exchange(other.process_, -1)), pipe_(std::exchange(other.pipe_, -1)) {}

VideoEncoder::~VideoEncoder() {
    if (pipe_ >= 0) {
        ::close(pipe_);
    }
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
}

Result<void> VideoEncoder::write(const Image& picture, int /*index*/) {
    const auto bytes = std::as_bytes(picture.samples());
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::write(pipe_, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR) {
            return failed("ended before the last frame");
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return {};
}

Result<void> VideoEncoder::finish(std::vector<AtomicFile>& outputs) {
    ::close(std::exchange(pipe_, -1));
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    const bool ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    const auto said = messages_.bytes();
    // ffmpeg exits with 0 on a full disk, too.
    if (!ended_well || !said || !said->empty()) {
        return failed("could not encode the video");
    }
    outputs.push_back(std::move(file_));
    return {};
}

Error VideoEncoder::failed(std::string_view what) const {
    const auto said = messages_.bytes();
    const std::string_view text =
        said ? std::string_view(reinterpret_cast<const char*>(said->data()), said->size()) : "";
    const std::string_view line = text.substr(0, text.find('\n'));
    return {fmt::format("{}: ffmpeg {}{}{}", file_.target().string(), what,
                        line.empty() ? "" : ": ", line)};
}

} // namespace reljef::app
