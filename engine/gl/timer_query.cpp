#include "engine/gl/timer_query.h"

#include <glad/gl.h>

namespace reljef::gl {

TimerQuery TimerQuery::create() {
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    TimerQuery query;
    query.id_ = UniqueId<delete_query>(name);
    return query;
}

void TimerQuery::begin() {
    ended_ = false;
    glBeginQuery(GL_TIME_ELAPSED, id());
}

void TimerQuery::end() {
    glEndQuery(GL_TIME_ELAPSED);
    ended_ = true;
}

std::optional<std::chrono::nanoseconds> TimerQuery::poll() const {
    if (!ended_ || id() == 0U) {
        return std::nullopt;
    }
    GLint available = GL_FALSE;
    glGetQueryObjectiv(id(), GL_QUERY_RESULT_AVAILABLE, &available);
    if (available == GL_FALSE) {
        return std::nullopt;
    }
    GLint64 elapsed = 0;
    glGetQueryObjecti64v(id(), GL_QUERY_RESULT, &elapsed);
    return std::chrono::nanoseconds(elapsed);
}

} // namespace reljef::gl
