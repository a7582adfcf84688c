// A library for LD_PRELOAD that makes one call of a program fail. A call site is the return address
// in the program nearest to the call, and the address of the call itself, which may be a library's.
// By environment variables:
//   RELJEF_FAULT_LIST=FILE  appends each new site as a line "KIND KEY"
//   RELJEF_FAULT=KEY        the first call from this site fails
//   RELJEF_FAULT_DONE=FILE  appends the line "failed" when it does
//   RELJEF_FAULT_STOP=N     the process ends before its N-th change of a file, counted from 1
//   RELJEF_FAULT_COUNT=FILE at exit: the number of changes, and of files that were renamed without
//                           having been synced
//   RELJEF_FAULT_SERVER=N   at its main function the program serves requests at the socket N
//                           (fork_server.h): it is linked once, and each fork has variables of its
//                           own
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <span>
#include <string_view>

#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "tests/support/forks/fork_server.h"

namespace {

enum class Kind : std::uint64_t { allocation = 1, open, read, write };
constexpr std::array<const char*, 5> kind_names{"", "allocation", "open", "read", "write"};

struct Range {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    [[nodiscard]] bool has(std::uintptr_t address) const {
        return address >= begin && address < end;
    }
};

// A set of numbers that allocates nothing.
class Numbers {
public:
    /// Whether it is new.
    bool add(std::uint64_t number) {
        for (std::size_t i = number % places_.size();; i = (i + 1) % places_.size()) {
            std::uint64_t empty = 0;
            if (places_[i].compare_exchange_strong(empty, number)) {
                return true;
            }
            if (empty == number) {
                return false;
            }
        }
    }
    void remove(std::uint64_t number) {
        for (auto& place : places_) {
            std::uint64_t found = number;
            place.compare_exchange_strong(found, 1); // no place becomes empty
        }
    }
    [[nodiscard]] bool has(std::uint64_t number) const {
        for (std::size_t i = number % places_.size();; i = (i + 1) % places_.size()) {
            const std::uint64_t found = places_[i];
            if (found == 0 || found == number) {
                return found == number;
            }
        }
    }

private:
    std::array<std::atomic<std::uint64_t>, 1 << 16> places_{};
};

std::uint64_t number_in(const char* name, int base) {
    const char* const text = std::getenv(name);
    std::uint64_t number = 0;
    if (text != nullptr) {
        std::from_chars(text, text + std::strlen(text), number, base);
    }
    return number;
}

void write_line(int file, std::string_view line) {
    static_cast<void>(::syscall(SYS_write, file, line.data(), line.size()));
}

int opened(const char* variable) {
    const char* const name = std::getenv(variable);
    return name != nullptr
               ? static_cast<int>(::syscall(SYS_openat, AT_FDCWD, name,
                                            O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666))
               : -1;
}

class Faults {
public:
    Faults() {
        ::dl_iterate_phdr(&Faults::add_object, this);
        void* frame = nullptr;
        ::backtrace(&frame, 1); // loads what it needs
    }
    Faults(const Faults&) = delete;
    Faults& operator=(const Faults&) = delete;
    ~Faults() { end(); }

    /// Calls before main() do not count: they are those of libraries' global objects.
    void begin() {
        list_ = opened("RELJEF_FAULT_LIST");
        count_ = opened("RELJEF_FAULT_COUNT");
        done_ = opened("RELJEF_FAULT_DONE");
        failing_ = number_in("RELJEF_FAULT", 16);
        stop_ = number_in("RELJEF_FAULT_STOP", 10);
        is_ready_ = true;
    }
    void end() {
        is_ready_ = false;
        std::array<char, 80> line{};
        const int length = std::snprintf(line.data(), line.size(), "%llu %llu\n",
                                         static_cast<unsigned long long>(changes_),
                                         static_cast<unsigned long long>(unsynced_));
        write_line(count_, {line.data(), static_cast<std::size_t>(length)});
    }

    bool fails(Kind kind) {
        thread_local bool is_inside = false;
        if (!is_ready_ || is_inside || (list_ < 0 && (kind_of(failing_) != kind || has_failed_))) {
            return false;
        }
        is_inside = true;
        const std::uint64_t site = site_of(kind);
        const bool fails = site != 0 && is_due(kind, site);
        is_inside = false;
        return fails;
    }

    // A file is to be changed.
    void change() {
        if (is_ready_ && ++changes_ == stop_) {
            ::_exit(9);
        }
    }
    void sync(int file) {
        if (is_ready_) {
            synced_.add(number_of(file));
        }
    }
    void write(int file) {
        if (is_ready_) {
            synced_.remove(number_of(file));
        }
    }
    void rename(const char* from) {
        struct stat status {};
        if (is_ready_ && ::stat(from, &status) == 0 && S_ISREG(status.st_mode) &&
            !synced_.has(status.st_ino + 2)) {
            ++unsynced_;
        }
    }

private:
    static int add_object(dl_phdr_info* info, std::size_t /*size*/, void* self) {
        auto& faults = *static_cast<Faults*>(self);
        Range range;
        for (const auto& part : std::span(info->dlpi_phdr, info->dlpi_phnum)) {
            if (part.p_type == PT_LOAD) {
                const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
                range.begin = range.begin == 0 ? begin : std::min(range.begin, begin);
                range.end = std::max(range.end, begin + part.p_memsz);
            }
        }
        const std::string_view name(info->dlpi_name);
        if (faults.program_.end == 0) {
            faults.program_ = range;
        } else if (name.find("libstdc++") != std::string_view::npos) {
            faults.library_ = range;
        } else if (name.find("/libc.so") != std::string_view::npos) {
            faults.c_library_ = range;
        } else if (range.has(reinterpret_cast<std::uintptr_t>(&Faults::add_object))) {
            faults.own_ = range;
        }
        return 0;
    }
    static std::uint64_t number_of(int file) {
        struct stat status {};
        return ::fstat(file, &status) == 0 ? status.st_ino + 2 : 1;
    }

    // 0 if the program did not make the call. Memory that other libraries lack is theirs.
    std::uint64_t site_of(Kind kind) const {
        std::array<void*, 64> frames{};
        const int count = ::backtrace(frames.data(), static_cast<int>(frames.size()));
        std::uintptr_t caller = 0;
        std::uint64_t site = 0;
        for (void* const frame : std::span(frames).first(static_cast<std::size_t>(count))) {
            const auto address = reinterpret_cast<std::uintptr_t>(frame);
            if (own_.has(address)) {
                continue;
            }
            if (site != 0) {
                return kind != Kind::allocation || is_ours(address) ? site : 0;
            }
            if (program_.has(address)) {
                site = key_of(kind, address - program_.begin, caller);
            } else if (kind == Kind::allocation && !library_.has(address)) {
                return 0;
            }
            caller = caller == 0 ? offset_of(address) : caller;
        }
        return site;
    }
    // The caller of a function of the program: libraries share its instances of templates.
    [[nodiscard]] bool is_ours(std::uintptr_t address) const {
        return program_.has(address) || library_.has(address) || c_library_.has(address);
    }
    static std::uintptr_t offset_of(std::uintptr_t address) {
        Dl_info info{};
        ::dladdr(reinterpret_cast<void*>(address), &info);
        return address - reinterpret_cast<std::uintptr_t>(info.dli_fbase);
    }
    // FNV-1a of the numbers, above the kind; never 0 or 1.
    static std::uint64_t key_of(Kind kind, std::uint64_t site, std::uint64_t caller) {
        std::uint64_t hash = 0xCBF29CE484222325U;
        for (const std::uint64_t number : {static_cast<std::uint64_t>(kind), site, caller}) {
            hash = (hash ^ number) * 0x100000001B3U;
        }
        return hash << 4U | 8U | static_cast<std::uint64_t>(kind);
    }
    static Kind kind_of(std::uint64_t key) { return static_cast<Kind>(key & 7U); }

    bool is_due(Kind kind, std::uint64_t site) {
        if (list_ >= 0 && seen_.add(site)) {
            std::array<char, 80> line{};
            const int length = std::snprintf(line.data(), line.size(), "%s %llx\n",
                                             kind_names[static_cast<std::size_t>(kind)],
                                             static_cast<unsigned long long>(site));
            write_line(list_, {line.data(), static_cast<std::size_t>(length)});
        }
        const bool fails = site == failing_ && !has_failed_.exchange(true);
        if (fails) {
            write_line(done_, "failed\n");
        }
        return fails;
    }

    Range program_;
    Range library_; // the standard C++ library
    Range c_library_;
    Range own_;
    int list_ = -1;
    int count_ = -1;
    int done_ = -1;
    std::uint64_t failing_ = 0;
    std::uint64_t stop_ = 0;
    std::atomic<bool> is_ready_{false};
    std::atomic<bool> has_failed_{false};
    std::atomic<std::uint64_t> changes_{0};
    std::atomic<std::uint64_t> unsynced_{0};
    Numbers seen_;
    Numbers synced_;
};

Faults faults; // calls before are not counted

template <class Function> Function* original(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void* allocated(std::size_t size, std::size_t alignment) {
    if (faults.fails(Kind::allocation)) {
        return nullptr;
    }
    constexpr std::size_t usual = alignof(std::max_align_t);
    size = std::max<std::size_t>(size, 1);
    return alignment <= usual
               ? std::malloc(size)
               : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* allocated_or_thrown(std::size_t size, std::size_t alignment) {
    void* const memory = allocated(size, alignment);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}

bool fails(Kind kind, int error) {
    if (!faults.fails(kind)) {
        return false;
    }
    errno = error;
    return true;
}

bool write_fails(int file) {
    if (file <= STDERR_FILENO) {
        return false;
    }
    faults.change();
    faults.write(file);
    return fails(Kind::write, ENOSPC);
}

bool read_fails(int file) {
    return file > STDERR_FILENO && fails(Kind::read, EIO);
}

} // namespace

// NOLINTBEGIN(readability-identifier-naming,misc-new-delete-overloads)

void* operator new(std::size_t size) {
    return allocated_or_thrown(size, 1);
}
void* operator new[](std::size_t size) {
    return allocated_or_thrown(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocated_or_thrown(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocated_or_thrown(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return allocated(size, 1);
}
void* operator new[](std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
    return allocated(size, 1);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t /*size*/,
                       std::align_val_t /*alignment*/) noexcept {
    std::free(memory);
}

extern "C" {

using Main = int(int, char**, char**);

namespace {
Main* main_of_program = nullptr;

int forked_main(int count, char** arguments) {
    faults.begin();
    const int exit_code = main_of_program(count, arguments, ::environ);
    std::fflush(nullptr);
    faults.end();
    return exit_code;
}

int begin_main(int count, char** arguments, char** environment) {
    ::dlopen(RELJEF_PICTURES, RTLD_NOW | RTLD_LOCAL); // its global objects count as those of others
    if (std::getenv("RELJEF_FAULT_SERVER") != nullptr) {
        reljef::test::serve_forks(static_cast<int>(number_in("RELJEF_FAULT_SERVER", 10)),
                                  &forked_main);
    }
    faults.begin();
    return main_of_program(count, arguments, environment);
}
} // namespace

int __libc_start_main(Main* main, int count, char** arguments, void (*init)(), void (*fini)(),
                      void (*linker_fini)(), void* stack_end) {
    static auto* const next =
        original<int(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*)>(
            "__libc_start_main");
    main_of_program = main;
    return next(&begin_main, count, arguments, init, fini, linker_fini, stack_end);
}

using OpenFunction = int(const char*, int, ...);
using OpenAtFunction = int(int, const char*, int, ...);

#define RELJEF_OPEN(NAME)                                                                          \
    int NAME(const char* path, int flags, ...) {                                                   \
        static OpenFunction* const next = original<OpenFunction>(#NAME);                           \
        std::va_list rest;                                                                         \
        va_start(rest, flags);                                                                     \
        const auto mode = va_arg(rest, mode_t);                                                    \
        va_end(rest);                                                                              \
        return fails(Kind::open, EMFILE) ? -1 : next(path, flags, mode);                           \
    }
#define RELJEF_OPENAT(NAME)                                                                        \
    int NAME(int folder, const char* path, int flags, ...) {                                       \
        static OpenAtFunction* const next = original<OpenAtFunction>(#NAME);                       \
        std::va_list rest;                                                                         \
        va_start(rest, flags);                                                                     \
        const auto mode = va_arg(rest, mode_t);                                                    \
        va_end(rest);                                                                              \
        return fails(Kind::open, EMFILE) ? -1 : next(folder, path, flags, mode);                   \
    }
RELJEF_OPEN(open)
RELJEF_OPEN(open64)
RELJEF_OPENAT(openat)
RELJEF_OPENAT(openat64)

// A function that fails with `RESULT` if `FAILS`.
#define RELJEF_CALL(RETURN, NAME, PARAMETERS, ARGUMENTS, FAILS, RESULT)                            \
    RETURN NAME PARAMETERS {                                                                       \
        static auto* const next = original<RETURN PARAMETERS>(#NAME);                              \
        return (FAILS) ? (RESULT) : next ARGUMENTS;                                                \
    }

RELJEF_CALL(int, __open_2, (const char* path, int flags), (path, flags), fails(Kind::open, EMFILE),
            -1)
RELJEF_CALL(int, __open64_2, (const char* path, int flags), (path, flags),
            fails(Kind::open, EMFILE), -1)
RELJEF_CALL(FILE*, fopen, (const char* path, const char* mode), (path, mode),
            fails(Kind::open, EMFILE), nullptr)
RELJEF_CALL(FILE*, fopen64, (const char* path, const char* mode), (path, mode),
            fails(Kind::open, EMFILE), nullptr)
RELJEF_CALL(DIR*, opendir, (const char* path), (path), fails(Kind::open, EMFILE), nullptr)
RELJEF_CALL(int, memfd_create, (const char* name, unsigned flags), (name, flags),
            fails(Kind::open, EMFILE), -1)

RELJEF_CALL(ssize_t, read, (int file, void* to, std::size_t size), (file, to, size),
            read_fails(file), -1)
RELJEF_CALL(ssize_t, __read_chk, (int file, void* to, std::size_t size, std::size_t room),
            (file, to, size, room), read_fails(file), -1)
RELJEF_CALL(ssize_t, pread, (int file, void* to, std::size_t size, off_t at), (file, to, size, at),
            read_fails(file), -1)
RELJEF_CALL(ssize_t, pread64, (int file, void* to, std::size_t size, off64_t at),
            (file, to, size, at), read_fails(file), -1)
RELJEF_CALL(std::size_t, fread, (void* to, std::size_t size, std::size_t count, FILE* file),
            (to, size, count, file), read_fails(::fileno(file)), 0)

RELJEF_CALL(ssize_t, write, (int file, const void* from, std::size_t size), (file, from, size),
            write_fails(file), -1)
RELJEF_CALL(ssize_t, pwrite, (int file, const void* from, std::size_t size, off_t at),
            (file, from, size, at), write_fails(file), -1)
RELJEF_CALL(ssize_t, pwrite64, (int file, const void* from, std::size_t size, off64_t at),
            (file, from, size, at), write_fails(file), -1)
RELJEF_CALL(std::size_t, fwrite,
            (const void* from, std::size_t size, std::size_t count, FILE* file),
            (from, size, count, file), write_fails(::fileno(file)), 0)
RELJEF_CALL(int, ftruncate, (int file, off_t size), (file, size), write_fails(file), -1)
RELJEF_CALL(int, ftruncate64, (int file, off64_t size), (file, size), write_fails(file), -1)
RELJEF_CALL(int, mkdir, (const char* path, mode_t mode), (path, mode), write_fails(INT_MAX), -1)
RELJEF_CALL(int, unlink, (const char* path), (path), (faults.change(), false), -1)

int fsync(int file) {
    static auto* const next = original<int(int)>("fsync");
    faults.change();
    if (fails(Kind::write, EIO)) {
        return -1;
    }
    const int result = next(file);
    faults.sync(file);
    return result;
}

int rename(const char* from, const char* to) noexcept {
    static auto* const next = original<int(const char*, const char*)>("rename");
    faults.change();
    if (fails(Kind::write, EIO)) {
        return -1;
    }
    faults.rename(from);
    return next(from, to);
}

} // extern "C"

// NOLINTEND(readability-identifier-naming,misc-new-delete-overloads)
