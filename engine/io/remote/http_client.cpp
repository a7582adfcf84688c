#include "engine/io/remote/http_client.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <numeric>
#include <thread>
#include <utility>

#include <cpl_conv.h>
#include <fmt/format.h>

#include "engine/io/remote/http_transfer.h"
#include "engine/io/remote/read_scope.h"

namespace reljef::io {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr long max_connections = 8; // of one read
constexpr std::chrono::milliseconds stop_latency{50};
// That take the time of one request each. The samples of a read have at most 16 MB, which come
// within these 300 s at half a megabit a second.
constexpr double max_requests = 5.0;

double seconds_option(const char* name, double usual) {
    return CPLAtof(CPLGetConfigOption(name, std::to_string(usual).c_str()));
}

/// All transfers of one read.
class HttpRead {
public:
    HttpRead(CURLM* multi, const ReadLimits& limits, const std::string& url,
             std::span<const ByteRange> ranges)
        : multi_(multi), limits_(limits) {
        for (const ByteRange& range : ranges) {
            pending_.push_back(&transfers_.emplace_back(url, range));
        }
    }

    Result<std::vector<HttpPart>> run(int max_retries) {
        int retries = 0;
        while (!pending_.empty()) {
            if (auto done = transfer_pending(); !done) {
                return done.error();
            }
            const auto problem = evaluate_pending();
            if (!problem) {
                return problem.error();
            }
            if (!problem->empty()) {
                if (++retries > max_retries) {
                    return Error{*problem};
                }
                if (auto waited = wait(seconds_option("GDAL_HTTP_RETRY_DELAY", 1.0)); !waited) {
                    return waited.error();
                }
            }
        }
        std::vector<HttpPart> parts;
        std::transform(transfers_.begin(), transfers_.end(), std::back_inserter(parts),
                       [](HttpTransfer& transfer) { return transfer.take(); });
        return parts;
    }

private:
    /// Makes the next request of each pending transfer.
    Result<void> transfer_pending() {
        for (HttpTransfer* transfer : pending_) {
            handles_.push_back(transfer->prepare());
            curl_multi_add_handle(multi_, handles_.back());
        }
        int running = 1;
        Result<void> good = check_limits();
        while (good && running > 0) {
            curl_multi_perform(multi_, &running);
            note_outcomes();
            good = running > 0 ? check_limits() : good;
            if (good && running > 0) {
                curl_multi_poll(multi_, nullptr, 0, static_cast<int>(stop_latency.count()),
                                nullptr);
            }
        }
        for (CURL* handle : handles_) {
            curl_multi_remove_handle(multi_, handle);
        }
        handles_.clear();
        return good;
    }

    void note_outcomes() {
        int left = 0;
        while (const CURLMsg* message = curl_multi_info_read(multi_, &left)) {
            HttpTransfer* transfer = nullptr;
            curl_easy_getinfo(message->easy_handle, CURLINFO_PRIVATE, &transfer);
            transfer->set_outcome(message->data.result);
        }
    }

    /// The error after which requests must be repeated; empty: none.
    Result<std::string> evaluate_pending() {
        std::string problem;
        std::vector<HttpTransfer*> again;
        for (HttpTransfer* transfer : pending_) {
            const auto next = transfer->evaluate();
            if (!next) {
                return next.error();
            }
            if (*next != HttpTransfer::Next::finished) {
                again.push_back(transfer);
            }
            if (*next == HttpTransfer::Next::retry) {
                problem = transfer->problem();
            }
        }
        pending_ = std::move(again);
        return problem;
    }

    Result<void> wait(double seconds) const {
        const auto end = Clock::now() + Seconds(seconds);
        Result<void> good = check_limits();
        while (good && Clock::now() < end) {
            std::this_thread::sleep_for(stop_latency);
            good = check_limits();
        }
        return good;
    }

    /// Fails after a stop request or a deadline.
    [[nodiscard]] Result<void> check_limits() const {
        if (ReadScope::stop_requested()) {
            return Error{"reading was stopped"};
        }
        const auto received = std::accumulate(
            transfers_.begin(), transfers_.end(), std::size_t{0},
            [](std::size_t sum, const HttpTransfer& one) { return sum + one.received(); });
        const double seconds = Seconds(Clock::now() - begin_).count();
        const auto bytes = static_cast<double>(received);
        if (seconds > limits_.start + bytes / limits_.min_bytes_per_second) {
            return Error{fmt::format("{} bytes came in {:.0f} s, at least {:.0f} a second after "
                                     "the first {:.0f} s were expected",
                                     received, seconds, limits_.min_bytes_per_second,
                                     limits_.start)};
        }
        const double max_seconds = seconds_option("GDAL_HTTP_TIMEOUT", 60.0);
        if (seconds > max_seconds) {
            return Error{fmt::format("{} bytes came in {:.0f} s, all were expected within {:.0f} s",
                                     received, seconds, max_seconds)};
        }
        if (ReadDeadline::seconds() > max_requests * max_seconds) {
            return Error{
                fmt::format("opening or reading a part took {:.0f} s in all, at most {:.0f} "
                            "s were expected",
                            ReadDeadline::seconds(), max_requests * max_seconds)};
        }
        return {};
    }

    CURLM* multi_;
    const ReadLimits& limits_;
    Clock::time_point begin_ = Clock::now();
    std::deque<HttpTransfer> transfers_;
    std::vector<HttpTransfer*> pending_;
    std::vector<CURL*> handles_;
};

} // namespace

HttpClient::HttpClient(ReadLimits limits) : limits_(limits) {
    curl_global_init(CURL_GLOBAL_DEFAULT);
}

void HttpClient::MultiCloser::operator()(void* multi) const {
    curl_multi_cleanup(multi);
}

HttpClient::Multi HttpClient::borrow() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) {
        Multi made(curl_multi_init());
        check(made != nullptr, "libcurl has no memory");
        curl_multi_setopt(made.get(), CURLMOPT_MAX_TOTAL_CONNECTIONS, max_connections);
        return made;
    }
    Multi multi = std::move(idle_.back());
    idle_.pop_back();
    return multi;
}

Result<std::vector<HttpPart>> HttpClient::read(const std::string& url,
                                               std::span<const ByteRange> ranges, int max_retries) {
    if (!url.starts_with("http://") && !url.starts_with("https://")) {
        return Error{"an http:// or https:// address was expected"};
    }
    Multi multi = borrow();
    auto parts = HttpRead(multi.get(), limits_, url, ranges).run(max_retries);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(multi));
    return parts;
}

} // namespace reljef::io
