// Large arrays lie on large pages: the kernel fills 512 times fewer pages, and rays over wide
// terrain miss fewer addresses of pages. Linked into programs, not into the library.
#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t large_page = std::size_t{1} << 21;
constexpr std::size_t smallest_array = 2 * large_page; // a smaller one may hold no whole page

void* allocate(std::size_t size) {
    if (size < smallest_array) {
        return std::malloc(size > 0 ? size : 1);
    }
    void* const array = std::aligned_alloc(large_page, size);
    if (array != nullptr) {
        ::madvise(array, size, MADV_HUGEPAGE); // kernels without large pages refuse: no harm
    }
    return array;
}

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
