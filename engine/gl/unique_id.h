#pragma once

#include <utility>

namespace reljef::gl {

void delete_buffer(unsigned int id);
void delete_texture(unsigned int id);
void delete_renderbuffer(unsigned int id);
void delete_vertex_array(unsigned int id);
void delete_framebuffer(unsigned int id);
void delete_shader(unsigned int id);
void delete_program(unsigned int id);
void delete_query(unsigned int id);

/// Owns a GL object by its name; 0, also after a move, is no object. The object's context must be
/// current when the object is made, used and destroyed.
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
