// Large arrays lie on large pages: the kernel fills 512 times fewer pages, and rays over wide
// terrain miss fewer addresses of pages. Linked into programs, not into the library.
#include <malloc.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t large_page = std::size_t{1} << 21;
constexpr std::size_t smallest_array = 2 * large_page; // the alignment costs up to a page more

void* allocate(std::size_t size) {
    if (size < smallest_array) {
        return std::malloc(size > 0 ? size : 1);
    }
    void* const array = std::aligned_alloc(large_page, size);
    if (array != nullptr) {
        const int before = errno;
        ::madvise(array, size, MADV_HUGEPAGE); // kernels without large pages refuse: no harm
        errno = before;
    }
    return array;
}

#ifdef __GLIBC__
// glibc raises its threshold for mapped blocks when they are freed, and keeps later ones. A fixed
// one also fixes the size from which the heap's end is given back: at 128 kB, which would come and
// go with each smaller array, and 80 times in a frame of a software renderer.
[[gnu::constructor]] void return_freed_arrays() {
    ::mallopt(M_MMAP_THRESHOLD, int{smallest_array});
    ::mallopt(M_TRIM_THRESHOLD, 2 * int{smallest_array}); // glibc's proportion
}
#endif

} // namespace

void* operator new(std::size_t size) {
    for (;;) {
        if (void* const array = allocate(size)) {
            return array;
        }
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) {
            throw std::bad_alloc();
        }
        handler();
    }
}

void operator delete(void* array) noexcept {
    std::free(array);
}

void operator delete(void* array, std::size_t /*size*/) noexcept {
    std::free(array);
}
