#pragma once

#include <utility>

namespace reljef::gl {

/// Deletes the object of that name; 0 and a moved-from owner's 0 are no object.
void delete_buffer(unsigned int id);
void delete_texture(unsigned int id);
void delete_renderbuffer(unsigned int id);
void delete_vertex_array(unsigned int id);
void delete_framebuffer(unsigned int id);
void delete_shader(unsigned int id);
void delete_program(unsigned int id);
void delete_query(unsigned int id);

/// The name of a GL object, deleted with its owner; 0 is none. The object's context must be current
/// when it is made, used and destroyed.
template <void (*destroy)(unsigned int)> class UniqueId {
public:
    UniqueId() = default;
    explicit UniqueId(unsigned int id) : id_(id) {}
    UniqueId(UniqueId&& other) noexcept : id_(std::exchange(other.id_, 0U)) {}
    UniqueId& operator=(UniqueId&& other) noexcept {
        if (this != &other) {
            reset(std::exchange(other.id_, 0U));
        }
        return *this;
    }
    UniqueId(const UniqueId&) = delete;
    UniqueId& operator=(const UniqueId&) = delete;
    ~UniqueId() { reset(0U); }

    [[nodiscard]] unsigned int get() const { return id_; }

private:
    void reset(unsigned int id) {
        const unsigned int old = std::exchange(id_, id);
        if (old != 0U) {
            destroy(old);
        }
    }

    unsigned int id_ = 0;
};

} // namespace reljef::gl
