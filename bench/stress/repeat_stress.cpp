// The same picture again: twice, with other pictures between, with other numbers of threads, and
// after a thousand other contexts.
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>

#include <csignal>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/runner/benchmark_scene.h"
#include "bench/stress/made_surfaces.h"
#include "bench/stress/stress_stage.h"
#include "engine/core/atomic_file.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {
namespace {

scene::Camera pose_of(const StressStage& stage, scene::Pose pose) {
    return scene::pose_camera(pose, stage.surface().bounds(), [&](double x, double y) {
        return stage.surface().height_at(x, y).value_or(0.0);
    });
}

struct Frame {
    Image picture;
    HitBuffer hits;
};

Result<Frame> draw_frame(session::SceneRenderer& renderer, StressStage& stage, scene::Pose pose) {
    stage.look(pose_of(stage, pose));
    auto picture = stage.picture(renderer);
    if (!picture) {
        return picture.error();
    }
    auto hits = stage.hits(renderer);
    if (!hits) {
        return hits.error();
    }
    return Frame{std::move(*picture), std::move(*hits)};
}

std::array<std::uint32_t, 6> bits_of(const Hit& hit) {
    return std::bit_cast<std::array<std::uint32_t, 6>>(hit);
}

double count_differences(const Frame& a, const Frame& b) {
    double count = 0.0;
    for (std::size_t i = 0; i < a.hits.size(); ++i) {
        const bool is_same = a.picture.samples()[i] == b.picture.samples()[i] &&
                             bits_of(a.hits.samples()[i]) == bits_of(b.hits.samples()[i]);
        count += is_same ? 0.0 : 1.0;
    }
    return count;
}

// FNV-1a of everything in a frame.
std::string bits_of(const Frame& frame) {
    std::uint64_t hash = 14695981039346656037ULL;
    const auto add = [&](auto pixels) {
        for (const std::byte byte : std::as_bytes(pixels)) {
            hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 1099511628211ULL;
        }
    };
    add(frame.picture.samples());
    add(frame.hits.samples());
    return fmt::format("{:016x}", hash);
}

// A line for each technique: its text, and the bits of a frame by `threads` threads.
Result<std::string> frames_by_threads(StressOptions options, int threads) {
    session::limit_software_threads(threads);
    options.suite.threads = threads;
    auto device = make_device(options.suite);
    auto stage = StressStage::create(made_hills(glm::ivec2(129), 2.0, 12.0));
    if (!device || !stage) {
        return device ? stage.error() : device.error();
    }
    std::string lines;
    for (const scene::Technique& technique : stressed_techniques(options)) {
        if (stage->set_technique(technique)) {
            const auto frame = draw_frame(device->renderer(), *stage, scene::Pose::overview);
            if (!frame) {
                return frame.error();
            }
            lines += fmt::format("{} {}\n", to_string(technique), bits_of(*frame));
        }
    }
    return lines;
}

// All that a process writes until it ends; ends early when stopped.
std::string read_all(int descriptor, const std::stop_token& stop) {
    std::string text;
    std::array<char, 4096> buffer{};
    while (!stop.stop_requested()) {
        pollfd waited{descriptor, POLLIN, 0};
        if (::poll(&waited, 1, 100) <= 0) {
            continue;
        }
        const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
        if (count <= 0) {
            break;
        }
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return text;
}

// llvmpipe takes its number of threads when a process first draws, so each number has a process.
Result<std::string> frames_of_process(const StressRun& run, int threads) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
        return Error{fmt::format("no pipe to a process: {}", std::strerror(errno))};
    }
    const Descriptor reading(ends[0]);
    Descriptor writing(ends[1]);
    const pid_t process = ::fork();
    if (process == 0) {
        const auto frames = frames_by_threads(run.options(), threads);
        const std::string text = frames ? *frames : "failed " + frames.error().message;
        const ssize_t written = ::write(writing.number(), text.data(), text.size());
        ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
    }
    if (process < 0) {
        return Error{fmt::format("no process for {} threads: {}", threads, std::strerror(errno))};
    }
    writing = Descriptor(); // so that the end of the process ends reading
    std::string text = read_all(reading.number(), run.stop());
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    if (text.empty() || text.starts_with("failed ")) {
        return Error{fmt::format("{} threads: {}", threads,
                                 text.empty() ? "no frames found, some were expected" : text)};
    }
    return text;
}

// Pixels that differ when a frame is drawn again, at once and after another one.
Result<double> differences_of_repeats(StressRun& run, StressStage& stage) {
    using scene::Pose;
    const auto first = draw_frame(run.renderer(), stage, Pose::overview);
    if (!first) {
        return first.error();
    }
    double differences = 0.0;
    for (const Pose pose : {Pose::overview, Pose::low, Pose::overview}) {
        const auto frame = draw_frame(run.renderer(), stage, pose);
        if (!frame) {
            return frame.error();
        }
        if (pose == Pose::overview) {
            differences = std::max(differences, count_differences(*first, *frame));
        }
    }
    return differences;
}

} // namespace

Result<void> stress_thread_counts(StressRun& run) {
    std::string first;
    Worst worst;
    for (const int threads : {1, 2, 3}) {
        const auto frames = frames_of_process(run, threads);
        if (run.stopped()) {
            return {};
        }
        if (!frames) {
            return frames.error();
        }
        first = first.empty() ? *frames : first;
        worst.add(*frames == first ? 0.0 : 1.0, fmt::format("{} threads", threads));
    }
    run.add(
        {.stress = "repeat",
         .terrain = "hills",
         .technique = fmt::format("{} techniques", std::count(first.begin(), first.end(), '\n')),
         .figure = "frames with other bits by 2 or 3 threads",
         .value = worst.value(),
         .limit = 0.0,
         .at = worst.at()});
    return {};
}

Result<void> stress_repeats(StressRun& run) {
    auto stage = StressStage::create(made_hills(glm::ivec2(129), 2.0, 12.0));
    if (!stage) {
        return stage.error();
    }
    for (const scene::Technique& technique : stressed_techniques(run.options())) {
        if (run.stopped() || !stage->set_technique(technique)) {
            continue;
        }
        const auto differences = differences_of_repeats(run, *stage);
        if (!differences) {
            return differences.error();
        }
        run.add({.stress = "repeat",
                 .terrain = "hills",
                 .technique = to_string(technique),
                 .figure = "pixels with other bits in the same frame",
                 .value = *differences,
                 .limit = 0.0});
    }
    run.renderer().forget_scene();
    return {};
}

Result<void> stress_contexts(StressRun& run) {
    const int count = run.cases(30, 1000);
    double failed = 0.0;
    for (int i = 0; i < count && !run.stopped(); ++i) {
        auto device = make_device(run.options().suite);
        failed += device ? 0.0 : 1.0;
    }
    run.add({.stress = "contexts",
             .figure = "contexts that could not be made",
             .value = failed,
             .limit = 0.0,
             .at = fmt::format("{} one after the other", count)});
    return {};
}

} // namespace reljef::bench
