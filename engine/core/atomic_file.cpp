#include "engine/core/atomic_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <set>
#include <system_error>

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace reljef {
namespace fs = std::filesystem;
namespace {

// Temporary files are named ".reljef-", 16 digits, ".part" and at most one extension; temporary
// folders have none.
constexpr std::string_view name_start = ".reljef-";
constexpr std::string_view name_end = ".part";
constexpr std::size_t name_digits = 16;
constexpr std::size_t name_length = name_start.size() + name_digits + name_end.size();

constexpr int max_links = 40; // as in Linux

// The last four digits follow from the 12 random ones: a name that a user made up has the right
// ones with a chance of 1/65536.
std::string digits_of(std::uint64_t random) {
    constexpr std::uint64_t multiplier = 0x9E3779B97F4A7C15; // Knuth's, of 64 bits
    const std::uint64_t first = random & ~std::uint64_t{0xffff};
    return fmt::format("{:016x}", first | (((first | 1U) * multiplier) >> 48U));
}

bool is_temporary_name(std::string_view name, bool is_folder) {
    if (name.size() < name_length || !name.starts_with(name_start)) {
        return false;
    }
    const std::string_view digits = name.substr(name_start.size(), name_digits);
    const std::string_view extension = name.substr(name_length);
    std::uint64_t number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    return digits == digits_of(number) &&
           name.substr(name_start.size() + name_digits).starts_with(name_end) &&
           (extension.empty() || (!is_folder && extension.rfind('.') == 0));
}

// Whether the path still names the open file.
bool is_at(const Descriptor& file, const fs::path& path) {
    struct stat opened {};
    struct stat found {};
    return ::fstat(file.number(), &opened) == 0 && ::lstat(path.c_str(), &found) == 0 &&
           opened.st_dev == found.st_dev && opened.st_ino == found.st_ino;
}

// Owners hold shared locks as long as they live, so an exclusive lock shows that the owner ended.
// False only if another process holds a lock: some file systems have no locks.
bool lock_shared(const Descriptor& file) {
    return ::flock(file.number(), LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

void remove_if_stale(const fs::path& folder, int folder_descriptor, const char* name) {
    const Descriptor found(
        ::openat(folder_descriptor, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (found && ::fstat(found.number(), &status) == 0 && status.st_uid == ::geteuid() &&
        (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode)) &&
        is_temporary_name(name, S_ISDIR(status.st_mode)) &&
        ::flock(found.number(), LOCK_EX | LOCK_NB) == 0) {
        std::error_code ignored;
        fs::remove_all(folder / name, ignored);
    }
}

struct Temporary {
    fs::path path;
    Descriptor descriptor; // locked; none: errno says why
};

// Empty if there are no random numbers; errno says why.
fs::path random_name(const fs::path& folder, std::string_view extension) {
    std::uint64_t random = 0;
    if (::getrandom(&random, sizeof(random), 0) != sizeof(random)) {
        return {};
    }
    return folder / fmt::format("{}{}{}{}", name_start, digits_of(random), name_end, extension);
}

// `make(path)` makes a new file or folder and returns its descriptor.
template <class Make>
Temporary make_temporary(const fs::path& folder, std::string_view extension, const Make& make) {
    constexpr int attempts = 8; // another process may remove one before it is locked
    Temporary made;
    for (int i = 0; i < attempts; ++i) {
        made.path = random_name(folder, extension);
        if (made.path.empty()) {
            return {};
        }
        made.descriptor = Descriptor(make(made.path.c_str()));
        if (!made.descriptor ||
            (lock_shared(made.descriptor) && is_at(made.descriptor, made.path))) {
            return made;
        }
        std::error_code ignored;
        fs::remove(made.path, ignored);
    }
    errno = EBUSY;
    return {};
}

Temporary make_temporary_file(const fs::path& folder, std::string_view extension) {
    return make_temporary(folder, extension, [](const char* name) {
        constexpr mode_t all_by_umask = 0666;
        return ::open(name, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, all_by_umask);
    });
}

// A hard link that is locked before it has its name. A file that cannot be opened needs no lock:
// only this user's processes remove what is stale, and they cannot open it either. The path is
// empty on failure.
Temporary link_to(const fs::path& file, const fs::path& folder) {
    Temporary made{
        {}, Descriptor(::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC))};
    if (made.descriptor && !lock_shared(made.descriptor)) {
        return made;
    }
    const fs::path name = random_name(folder, file.extension().string());
    if (!name.empty() && ::link(file.c_str(), name.c_str()) == 0) {
        made.path = name;
        if (made.descriptor && !is_at(made.descriptor, name)) { // replaced meanwhile
            ::unlink(name.c_str());
            made.path.clear();
        }
    }
    return made;
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

// The file that a chain of links names, also if there is none yet.
Result<fs::path> without_links(const fs::path& target) {
    fs::path place = target;
    std::error_code code;
    for (int i = 0; i < max_links && fs::is_symlink(fs::symlink_status(place, code)); ++i) {
        place = folder_of(place) / fs::read_symlink(place, code);
    }
    // In folders that all may write to, Linux refuses links of other users.
    const fs::file_status status = fs::status(target, code);
    if (status.type() == fs::file_type::none) {
        return Error{fmt::format("{}: cannot be written: {}", target.string(), code.message())};
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) { // never replaces /dev/null
        return Error{fmt::format("{}: cannot be written: it is a {}, a file was expected",
                                 target.string(), fs::is_directory(status) ? "folder" : "device")};
    }
    return place;
}

// A file system that cannot sync a folder is no reason to fail: the file is in its place already.
void sync_folder(const fs::path& folder) {
    if (const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
        opened) {
        static_cast<void>(::fsync(opened.number()));
    }
}

} // namespace

Descriptor::~Descriptor() {
    if (number_ >= 0) {
        ::close(number_);
    }
}

void remove_leftovers(const fs::path& folder) {
    const std::unique_ptr<DIR, int (*)(DIR*)> listing(
        ::opendir(folder.empty() ? "." : folder.c_str()), ::closedir);
    for (const dirent* entry = nullptr;
         listing != nullptr && (entry = ::readdir(listing.get())) != nullptr;) {
        if (is_temporary_name(entry->d_name, false)) {
            remove_if_stale(folder, ::dirfd(listing.get()), entry->d_name);
        }
    }
}

// Each is open as long as it lives, so the descriptors list them. Where a lock cannot become
// exclusive, another process owns the file, and a thread only looks at it.
void remove_own_temporaries() {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/fd", ignored)) {
        const fs::path path = fs::read_symlink(entry.path(), ignored);
        if (is_temporary_name(path.filename().string(), fs::is_directory(path, ignored)) &&
            ::flock(std::stoi(entry.path().filename()), LOCK_EX | LOCK_NB) == 0) {
            fs::remove_all(path, ignored);
        }
    }
}

Result<AtomicFile> AtomicFile::create(fs::path target) {
    AtomicFile file;
    file.target_ = std::move(target);
    if (file.target_.filename().empty()) {
        return file.error("a file name was expected");
    }
    const fs::path folder = folder_of(file.target_);
    std::error_code code;
    if (!fs::is_directory(folder, code)) {
        return file.error(fmt::format("there is no folder {}", folder.string()));
    }
    auto place = without_links(file.target_);
    if (!place) {
        return place.error();
    }
    file.place_ = std::move(*place);
    Temporary made = make_temporary_file(folder_of(file.place_), file.target_.extension().string());
    if (!made.descriptor) {
        return file.error(std::strerror(errno));
    }
    file.temporary_ = std::move(made.path);
    file.file_ = std::move(made.descriptor);
    return file;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)), place_(std::move(other.place_)),
      temporary_(std::exchange(other.temporary_, {})),
      replaced_(std::exchange(other.replaced_, {})), file_(std::move(other.file_)),
      old_(std::move(other.old_)) {}

AtomicFile& AtomicFile::operator=(AtomicFile other) noexcept {
    target_.swap(other.target_);
    place_.swap(other.place_);
    temporary_.swap(other.temporary_);
    replaced_.swap(other.replaced_);
    std::swap(file_, other.file_);
    std::swap(old_, other.old_);
    return *this;
}

AtomicFile::~AtomicFile() {
    std::error_code ignored;
    for (const fs::path* const leftover : {&temporary_, &replaced_}) {
        if (!leftover->empty()) {
            fs::remove(*leftover, ignored);
        }
    }
}

Error AtomicFile::error(std::string_view why) const {
    return {fmt::format("{}: cannot be written: {}", target_.string(), why)};
}

Result<void> AtomicFile::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file_.number(), bytes.data(), bytes.size());
        if (count < 0 && errno != EINTR) {
            return error(std::strerror(errno));
        }
        bytes = bytes.subspan(count > 0 ? static_cast<std::size_t>(count) : 0);
    }
    return {};
}

Result<void> AtomicFile::sync() {
    const bool is_done = ::fsync(file_.number()) == 0 || errno == EINVAL; // EINVAL: unsupported
    return is_done ? Result<void>() : error(std::strerror(errno));
}

Result<void> AtomicFile::rename() {
    if (!is_at(file_, temporary_)) {
        return error("its temporary file was replaced or removed");
    }
    if (::rename(temporary_.c_str(), place_.c_str()) != 0) {
        return error(std::strerror(errno));
    }
    temporary_.clear();
    return {};
}

Result<void> AtomicFile::commit() {
    if (auto synced = sync(); !synced) {
        return synced;
    }
    auto renamed = rename();
    if (renamed) {
        sync_folder(folder_of(place_));
    }
    return renamed;
}

// The backup is a hard link. It is a copy if the file system has no hard links, or if another
// program has locked the file.
Result<void> AtomicFile::rename_revertibly() {
    std::error_code code;
    if (fs::exists(place_, code)) {
        Temporary backup = link_to(place_, folder_of(place_));
        if (backup.path.empty()) {
            backup = make_temporary_file(folder_of(place_), place_.extension().string());
            if (!backup.descriptor) {
                return error(std::strerror(errno));
            }
            fs::copy_file(place_, backup.path, fs::copy_options::overwrite_existing, code);
        }
        replaced_ = std::move(backup.path);
        old_ = std::move(backup.descriptor);
    }
    return code ? error(code.message()) : rename();
}

void AtomicFile::revert() noexcept {
    std::error_code ignored;
    if (replaced_.empty()) {
        fs::remove(place_, ignored);
    } else {
        fs::rename(replaced_, place_, ignored);
        replaced_.clear();
    }
}

Result<void> commit_all(std::span<AtomicFile> files) {
    for (AtomicFile& file : files) {
        if (auto synced = file.sync(); !synced) {
            return synced;
        }
    }
    std::set<fs::path> folders;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (auto done = files[i].rename_revertibly(); !done) {
            while (i > 0) {
                files[--i].revert();
            }
            return done;
        }
        folders.insert(folder_of(files[i].place_));
    }
    for (const fs::path& folder : folders) {
        sync_folder(folder);
    }
    return {};
}

Result<AtomicFile> prepare_file(const fs::path& path, std::span<const std::byte> bytes) {
    auto file = AtomicFile::create(path);
    if (!file) {
        return file;
    }
    auto written = file->write(bytes);
    return written ? std::move(file) : written.error();
}

Result<void> write_file(const fs::path& path, std::span<const std::byte> bytes) {
    auto file = prepare_file(path, bytes);
    return file ? file->commit() : file.error();
}

Result<void> write_text_file(const fs::path& path, std::string_view text) {
    return write_file(path, std::as_bytes(std::span(text)));
}

std::string_view kind_of_file(const fs::path& path) {
    std::error_code code;
    switch (fs::status(path, code).type()) {
    case fs::file_type::regular:
        return "a file";
    case fs::file_type::directory:
        return "a folder";
    case fs::file_type::fifo:
        return "a pipe";
    case fs::file_type::socket:
        return "a socket";
    case fs::file_type::block:
    case fs::file_type::character:
        return "a device";
    default:
        return "nothing";
    }
}

Result<std::string> read_text_file(const fs::path& path, std::size_t limit) {
    std::error_code code;
    if (fs::is_directory(path, code)) {
        return Error{fmt::format("{}: is a folder, a file was expected", path.string())};
    }
    if (fs::is_fifo(path, code) || fs::is_socket(path, code)) { // opening one may never end
        return Error{fmt::format("{}: is no regular file, one was expected", path.string())};
    }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) {
        return Error{fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno))};
    }
    std::string text;
    std::array<char, 65536> buffer{};
    while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0) {
        text.append(buffer.data(), static_cast<std::size_t>(stream.gcount()));
        if (text.size() > limit) {
            return Error{fmt::format("{}: holds over {} bytes, at most that many were expected",
                                     path.string(), limit)};
        }
    }
    return text;
}

Result<ScratchFolder> ScratchFolder::create(fs::path parent) {
    std::error_code code;
    if (parent.empty()) {
        parent = fs::temp_directory_path(code);
    }
    if (code) {
        return Error{fmt::format("no folder for temporary files: {}", code.message())};
    }
    remove_leftovers(parent);
    Temporary made = make_temporary(parent, "", [](const char* name) {
        constexpr mode_t owner_only = 0700;
        return ::mkdir(name, owner_only) == 0
                   ? ::open(name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)
                   : -1;
    });
    if (!made.descriptor) {
        return Error{fmt::format("{}: no folder can be made in it: {}", parent.string(),
                                 std::strerror(errno))};
    }
    ScratchFolder folder;
    folder.path_ = std::move(made.path);
    folder.folder_ = std::move(made.descriptor);
    return folder;
}

ScratchFolder::~ScratchFolder() {
    const int reason = errno;
    std::error_code ignored;
    if (folder_) {
        fs::remove_all(path_, ignored);
    }
    errno = reason;
}

} // namespace reljef
