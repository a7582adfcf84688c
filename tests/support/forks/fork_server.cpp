#include "tests/support/forks/fork_server.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include <fcntl.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#include <sanitizer/lsan_interface.h>
#include <sys/mman.h>
#endif
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/child_process.h"

namespace reljef::test {
namespace {

constexpr std::size_t longest_request = 1 << 20; // bytes
constexpr std::size_t descriptors = 3;           // of a request: stdout, stderr, the answer

struct Request {
    ProgramMain program = nullptr; ///< null: the server's own
    std::vector<std::string> arguments;
    std::vector<std::string> environment;
    std::string folder;
    std::string input;
    std::array<int, descriptors> files{-1, -1, -1};
};

/// What the keeper of a program answers: its process as soon as there is one, then its end.
using Answer = std::int64_t;

void append(std::string& bytes, const std::vector<std::string>& texts) {
    bytes += std::to_string(texts.size()) + '\0';
    for (const std::string& text : texts) {
        bytes += text + '\0';
    }
}

std::string take_text(std::string_view& bytes) {
    std::string text(bytes.substr(0, bytes.find('\0')));
    bytes.remove_prefix(text.size() + 1);
    return text;
}

std::vector<std::string> take_texts(std::string_view& bytes) {
    std::vector<std::string> texts(std::stoul(take_text(bytes)));
    for (std::string& text : texts) {
        text = take_text(bytes);
    }
    return texts;
}

std::string bytes_of(const Request& request) {
    std::string bytes(sizeof request.program, '\0');
    std::memcpy(bytes.data(), &request.program, sizeof request.program);
    append(bytes, request.arguments);
    append(bytes, request.environment);
    append(bytes, {request.folder, request.input});
    return bytes;
}

Request request_of(std::string_view bytes) {
    Request request;
    std::memcpy(&request.program, bytes.data(), sizeof request.program);
    bytes.remove_prefix(sizeof request.program);
    request.arguments = take_texts(bytes);
    request.environment = take_texts(bytes);
    const auto places = take_texts(bytes);
    request.folder = places.at(0);
    request.input = places.at(1);
    return request;
}

/// A message with room for the descriptors.
struct Message {
    explicit Message(std::span<char> bytes) : part{bytes.data(), bytes.size()} {
        header.msg_iov = &part;
        header.msg_iovlen = 1;
        header.msg_control = control.data();
        header.msg_controllen = control.size();
    }
    Message(const Message&) = delete;
    Message& operator=(const Message&) = delete;

    iovec part;
    alignas(cmsghdr) std::array<char, CMSG_SPACE(descriptors * sizeof(int))> control{};
    msghdr header{};
};

bool send_request(int socket, const Request& request) {
    std::string bytes = bytes_of(request);
    Message message(bytes);
    cmsghdr& rights = *CMSG_FIRSTHDR(&message.header);
    rights.cmsg_level = SOL_SOCKET;
    rights.cmsg_type = SCM_RIGHTS;
    rights.cmsg_len = CMSG_LEN(sizeof request.files);
    std::memcpy(CMSG_DATA(&rights), request.files.data(), sizeof request.files);
    return ::sendmsg(socket, &message.header, MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

// Nothing where the tests have ended.
std::optional<Request> receive_request(int socket) {
    std::string bytes(longest_request, '\0');
    Message message(bytes);
    const ssize_t count = ::recvmsg(socket, &message.header, MSG_CMSG_CLOEXEC);
    const cmsghdr* const rights = CMSG_FIRSTHDR(&message.header);
    if (count <= static_cast<ssize_t>(sizeof(ProgramMain)) || rights == nullptr) {
        return std::nullopt;
    }
    Request request =
        request_of(std::string_view(bytes).substr(0, static_cast<std::size_t>(count)));
    std::memcpy(request.files.data(), CMSG_DATA(rights), sizeof request.files);
    return request;
}

#ifdef __SANITIZE_ADDRESS__
// Whether there are leaks, which stderr then tells. It is told nothing else: in a fork the
// sanitizer misses the threads of libraries, and says so.
bool leaks() {
    const int report = ::memfd_create("leaks", 0);
    __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(report)));
    if (__lsan_do_recoverable_leak_check() == 0) {
        return false;
    }
    std::array<char, 4096> part{};
    ::lseek(report, 0, SEEK_SET);
    for (ssize_t count = 0; (count = ::read(report, part.data(), part.size())) > 0;) {
        std::ignore = ::write(STDERR_FILENO, part.data(), static_cast<std::size_t>(count));
    }
    return true;
}
#endif

// Libraries that began threads of their own as they were loaded, which a fork lacks, would wait for
// them for ever at a usual end.
[[noreturn]] void end(int exit_code) {
    std::fflush(nullptr);
#ifdef __SANITIZE_ADDRESS__
    constexpr int exit_code_of_leaks = 23; // LeakSanitizer's
    exit_code = leaks() ? exit_code_of_leaks : exit_code;
#endif
    ::_exit(exit_code);
}

[[noreturn]] void run(Request request) {
    ::setpgid(0, 0);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) { // the tests may run in the background
        std::signal(signal, SIG_DFL);
    }
    const int input = ::open(request.input.c_str(), O_RDONLY);
    if (input < 0 || ::dup2(input, STDIN_FILENO) < 0 ||
        ::dup2(request.files[0], STDOUT_FILENO) < 0 ||
        ::dup2(request.files[1], STDERR_FILENO) < 0 ||
        (!request.folder.empty() && ::chdir(request.folder.c_str()) != 0)) {
        ::_exit(127);
    }
    ::close_range(STDERR_FILENO + 1, ~0U, 0);
    ::clearenv();
    for (std::string& entry : request.environment) {
        ::putenv(entry.data());
    }
    auto arguments = pointers_to(request.arguments);
    end(request.program(static_cast<int>(arguments.size()) - 1, arguments.data()));
}

void answer(int file, Answer what) {
    std::ignore = ::write(file, &what, sizeof what);
}

// Starts the program and stays until it ends.
[[noreturn]] void keep(Request request) {
    const int answers = request.files[2];
    const pid_t process = ::fork();
    if (process == 0) {
        run(std::move(request));
    }
    ::close(request.files[0]);
    ::close(request.files[1]);
    ::setpgid(process, process);
    answer(answers, process);
    int status = 127 << 8;
    while (process > 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    answer(answers, exit_code_of_status(status));
    ::_exit(0);
}

Answer next_answer(const Pipe& answers) {
    Answer found = -1;
    while (::read(answers.ends[0], &found, sizeof found) < 0 && errno == EINTR) {
    }
    return found;
}

} // namespace

bool make_fork_sockets(std::array<int, 2>& ends) {
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return false;
    }
    for (const int end : ends) {
        constexpr int room = 2 * static_cast<int>(longest_request);
        ::setsockopt(end, SOL_SOCKET, SO_SNDBUF, &room, sizeof room);
    }
    return true;
}

void serve_forks(int socket, ProgramMain own) {
    while (auto request = receive_request(socket)) {
        if (::fork() == 0) {
            ::close(socket);
            request->program = request->program == nullptr ? own : request->program;
            keep(std::move(*request));
        }
        for (const int file : request->files) {
            ::close(file);
        }
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }
    }
    while (::waitpid(-1, nullptr, 0) > 0) {
    }
    ::_exit(0);
}

ProgramResult run_fork(int server, ProgramMain program, std::vector<std::string> arguments,
                       const ProgramOptions& options) {
    ProgramResult result;
    Pipe out;
    Pipe err;
    Pipe answers;
    Request request{.program = program,
                    .arguments = std::move(arguments),
                    .environment = environment_with(options.environment),
                    .folder = options.folder.string(),
                    .input = options.input.string(),
                    .files = {out.ends[1], err.ends[1], answers.ends[1]}};
    if (!send_request(server, request)) {
        result.exit_code = 127;
        result.err = std::strerror(errno);
        return result;
    }
    for (Pipe* const pipe : {&out, &err, &answers}) {
        pipe->close_end(1);
    }
    const auto process = static_cast<int>(next_answer(answers));
    if (process <= 0) {
        result.exit_code = 127;
        return result;
    }
    read_all(out, err, process, options, result);
    result.exit_code = static_cast<int>(next_answer(answers));
    return result;
}

} // namespace reljef::test
