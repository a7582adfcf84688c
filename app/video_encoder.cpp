#include "app/video_encoder.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>
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
            // Most players want even sides and 4:2:0.
            "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p", file.string()};
}

Result<pid_t> start(const std::vector<std::string>& arguments, int input) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
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

// A write to an encoder that has ended must be an error here, not the end of the program.
class NoPipeSignal {
public:
    NoPipeSignal() : before_(std::signal(SIGPIPE, SIG_IGN)) {}
    NoPipeSignal(const NoPipeSignal&) = delete;
    NoPipeSignal& operator=(const NoPipeSignal&) = delete;
    ~NoPipeSignal() { std::signal(SIGPIPE, before_); }

private:
    void (*before_)(int);
};

} // namespace

Result<VideoEncoder> VideoEncoder::create(const std::filesystem::path& file, glm::ivec2 size,
                                          double frames_per_second) {
    auto output = AtomicFile::create(file);
    if (!output) {
        return output.error();
    }
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
        return Error{fmt::format("{}: no pipe to ffmpeg: {}", file.string(), std::strerror(errno))};
    }
    auto process = start(arguments_for(output->temporary(), size, frames_per_second), ends[0]);
    ::close(ends[0]);
    if (!process) {
        ::close(ends[1]);
        return Error{fmt::format("{}: {}", file.string(), process.error().message)};
    }
    return VideoEncoder(std::move(*output), *process, ends[1]);
}

VideoEncoder::VideoEncoder(VideoEncoder&& other) noexcept
    : file_(std::move(other.file_)), process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)) {}

VideoEncoder::~VideoEncoder() {
    if (pipe_ >= 0) {
        ::close(pipe_);
    }
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        ::waitpid(process_, nullptr, 0);
    }
}

Result<void> VideoEncoder::write(const Image& picture) {
    const NoPipeSignal guard;
    const auto bytes = std::as_bytes(picture.samples());
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::write(pipe_, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR) {
            return Error{fmt::format("{}: ffmpeg ended before the last frame: {}",
                                     file_.target().string(), std::strerror(errno))};
        }
        done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
    return {};
}

Result<void> VideoEncoder::finish() {
    ::close(std::exchange(pipe_, -1));
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return Error{fmt::format("{}: ffmpeg could not encode the video", file_.target().string())};
    }
    return file_.commit();
}

} // namespace reljef::app
