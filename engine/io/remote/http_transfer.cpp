#include "engine/io/remote/http_transfer.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>

#include "engine/io/remote/public_address.h"

namespace reljef::io {
namespace {

constexpr int max_redirects = 5;
constexpr std::size_t max_address_length = 200; // in messages, bytes

struct UserOption {
    const char* name; ///< GDAL's configuration
    CURLoption option;
};

constexpr std::array<UserOption, 7> text_options{{
    {"GDAL_HTTP_USERPWD", CURLOPT_USERPWD},
    {"GDAL_HTTP_BEARER", CURLOPT_XOAUTH2_BEARER},
    {"GDAL_HTTP_COOKIE", CURLOPT_COOKIE},
    {"GDAL_HTTP_PROXY", CURLOPT_PROXY},
    {"GDAL_HTTPS_PROXY", CURLOPT_PROXY},
    {"GDAL_HTTP_PROXYUSERPWD", CURLOPT_PROXYUSERPWD},
    {"CURL_CA_BUNDLE", CURLOPT_CAINFO},
}};

long number_option(const char* name, long usual) {
    return std::strtol(CPLGetConfigOption(name, std::to_string(usual).c_str()), nullptr, 10);
}

std::string shortened(const std::string& address) {
    return address.size() <= max_address_length
               ? address
               : fmt::format("{}…", address.substr(0, max_address_length));
}

/// The numbers of "bytes 0-99/1000".
struct ContentRange {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::uint64_t total = 0;
};

std::optional<ContentRange> parse_content_range(std::string_view text) {
    constexpr std::string_view unit = "bytes ";
    ContentRange range;
    if (!text.starts_with(unit)) {
        return std::nullopt;
    }
    const char* at = text.data() + unit.size();
    const char* const end = text.data() + text.size();
    for (const auto& [number, after] :
         {std::pair{&range.first, '-'}, {&range.last, '/'}, {&range.total, '\0'}}) {
        const auto [stop, code] = std::from_chars(at, end, *number);
        const bool ends_well = after == '\0' ? stop == end : stop != end && *stop == after;
        if (code != std::errc{} || !ends_well) {
            return std::nullopt;
        }
        at = stop == end ? end : stop + 1;
    }
    const bool ordered = range.first <= range.last && range.last < range.total;
    return ordered ? std::optional(range) : std::nullopt;
}

} // namespace

HttpTransfer::HttpTransfer(std::string url, ByteRange range)
    : range_(range), target_(std::move(url)), easy_(curl_easy_init()) {
    check(easy_ != nullptr, "libcurl has no memory");
}

template <class Value> void HttpTransfer::set(CURLoption option, Value value) {
    curl_easy_setopt(easy_.get(), option, value);
}

CURL* HttpTransfer::prepare() {
    part_ = {};
    too_long_ = false;
    refused_address_.clear();
    curl_easy_reset(easy_.get());
    curl_error_[0] = '\0';
    set(CURLOPT_PRIVATE, static_cast<void*>(this));
    set(CURLOPT_URL, target_.c_str());
    const std::string range = fmt::format("{}-{}", range_.first, range_.first + (range_.count - 1));
    set(CURLOPT_RANGE, range.c_str());
    set(CURLOPT_WRITEFUNCTION, &HttpTransfer::on_bytes);
    set(CURLOPT_WRITEDATA, static_cast<void*>(this));
    set(CURLOPT_ERRORBUFFER, curl_error_.data());
    set(CURLOPT_NOSIGNAL, 1L);
    set(CURLOPT_QUICK_EXIT, 1L); // does not wait for a name server
    set(CURLOPT_USERAGENT, CPLGetConfigOption("GDAL_HTTP_USERAGENT", "reljef"));
    set(CURLOPT_CONNECTTIMEOUT, number_option("GDAL_HTTP_CONNECTTIMEOUT", 10));
    set(CURLOPT_LOW_SPEED_TIME, number_option("GDAL_HTTP_LOW_SPEED_TIME", 10));
    set(CURLOPT_LOW_SPEED_LIMIT, number_option("GDAL_HTTP_LOW_SPEED_LIMIT", 100));
    const bool checks_certificates = !CPLTestBool(CPLGetConfigOption("GDAL_HTTP_UNSAFESSL", "NO"));
    set(CURLOPT_SSL_VERIFYPEER, checks_certificates ? 1L : 0L);
    set(CURLOPT_SSL_VERIFYHOST, checks_certificates ? 2L : 0L);
    if (redirects_ == 0) {
        set_users_options();
    } else {
        set_redirect_options();
    }
    return easy_.get();
}

void HttpTransfer::set_users_options() {
    set(CURLOPT_PROTOCOLS_STR, "http,https");
    set(CURLOPT_NETRC, static_cast<long>(CURL_NETRC_OPTIONAL));
    for (const auto& [name, option] : text_options) {
        const bool other_scheme =
            std::string_view(name) == "GDAL_HTTPS_PROXY" && !target_.starts_with("https://");
        const char* value = CPLGetConfigOption(name, nullptr);
        if (value != nullptr && !other_scheme) {
            set(option, value);
        }
    }
    const CPLStringList lines(CSLTokenizeString2(CPLGetConfigOption("GDAL_HTTP_HEADERS", ""), ",",
                                                 CSLT_HONOURSTRINGS | CSLT_STRIPLEADSPACES));
    headers_.reset();
    for (int i = 0; i < lines.size(); ++i) {
        headers_.reset(curl_slist_append(headers_.release(), lines[i]));
    }
    set(CURLOPT_HTTPHEADER, headers_.get());
}

void HttpTransfer::set_redirect_options() {
    set(CURLOPT_PROTOCOLS_STR, "https");
    set(CURLOPT_PROXY, ""); // only without a proxy, the host's own address is known
    set(CURLOPT_OPENSOCKETFUNCTION, &HttpTransfer::open_public);
    set(CURLOPT_OPENSOCKETDATA, static_cast<void*>(this));
    // Connections that are open already are checked here.
    set(CURLOPT_PREREQFUNCTION, &HttpTransfer::before_request);
    set(CURLOPT_PREREQDATA, static_cast<void*>(this));
}

std::size_t HttpTransfer::on_bytes(char* bytes, std::size_t /*size*/, std::size_t count,
                                   void* self) {
    return static_cast<HttpTransfer*>(self)->add(bytes, count);
}

std::size_t HttpTransfer::add(const char* bytes, std::size_t count) {
    received_ += count;
    long status = 0;
    curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status);
    if (status != 200 && status != 206) {
        return count; // an explanation
    }
    too_long_ = part_.bytes.size() + count > range_.count;
    if (too_long_) {
        return 0; // ends the request
    }
    part_.bytes.append(bytes, count);
    return count;
}

curl_socket_t HttpTransfer::open_public(void* self, curlsocktype /*purpose*/,
                                        curl_sockaddr* address) {
    if (!is_public(address->addr)) {
        std::array<char, 64> name{};
        ::getnameinfo(&address->addr, static_cast<socklen_t>(address->addrlen), name.data(),
                      name.size(), nullptr, 0, NI_NUMERICHOST);
        static_cast<HttpTransfer*>(self)->refused_address_ = name.data();
        return CURL_SOCKET_BAD;
    }
    return ::socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

int HttpTransfer::before_request(void* self, char* remote, char* /*local*/, int /*remote_port*/,
                                 int /*local_port*/) {
    if (is_public(remote)) {
        return CURL_PREREQFUNC_OK;
    }
    static_cast<HttpTransfer*>(self)->refused_address_ = remote;
    return CURL_PREREQFUNC_ABORT;
}

std::string HttpTransfer::header(const char* name) const {
    curl_header* found = nullptr;
    return curl_easy_header(easy_.get(), name, 0, CURLH_HEADER, -1, &found) == CURLHE_OK
               ? found->value
               : "";
}

Result<HttpTransfer::Next> HttpTransfer::evaluate() {
    if (redirects_ > 0 && code_ != CURLE_OK && !refused_address_.empty()) {
        return Error{fmt::format("is redirected to {} at {}, https:// addresses of public hosts "
                                 "were expected",
                                 shortened(target_), refused_address_)};
    }
    if (too_long_) {
        return Error{"the server sends more than the part that was requested, a server of parts "
                     "(byte ranges) was expected"};
    }
    long status = 0;
    curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status);
    const bool needs_body = status < 300;
    if (code_ == CURLE_OUT_OF_MEMORY && status != 0) { // libcurl 7.88's word for it
        return Error{"the server's answer has a header of over 100 kB, a shorter one was expected"};
    }
    if (code_ != CURLE_OK && needs_body) {
        return Error{curl_error_[0] != '\0' ? curl_error_.data() : curl_easy_strerror(code_)};
    }
    return check_answer(status);
}

Result<HttpTransfer::Next> HttpTransfer::check_answer(long status) {
    switch (status) {
    case 200:
    case 206:
        return check_part(status);
    case 204:
    case 404:
    case 410:
        part_.found = false;
        return Next::finished;
    case 301:
    case 302:
    case 303:
    case 307:
    case 308:
        return follow_redirect();
    case 429:
    case 500:
    case 502:
    case 503:
    case 504:
        problem_ = fmt::format("the server answers {}", status);
        return Next::retry;
    default:
        return Error{fmt::format("the server answers {}, 200 or 206 was expected", status)};
    }
}

Result<HttpTransfer::Next> HttpTransfer::follow_redirect() {
    const char* to = nullptr;
    curl_easy_getinfo(easy_.get(), CURLINFO_REDIRECT_URL, &to);
    // If libcurl does not understand the URL: the header as the server sent it.
    const std::string place = to != nullptr ? to : header("location");
    if (place.find_first_not_of(" \t\r\n") == std::string::npos) {
        return Error{"is redirected without an address, an https:// address of a public host was "
                     "expected"};
    }
    if (!place.starts_with("https://")) {
        return Error{
            fmt::format("is redirected to {}, https:// addresses of public hosts were expected",
                        shortened(place))};
    }
    if (++redirects_ > max_redirects) {
        return Error{fmt::format("is redirected more than {} times, at last to {}", max_redirects,
                                 shortened(place))};
    }
    target_ = place;
    return Next::request;
}

Result<HttpTransfer::Next> HttpTransfer::check_part(long status) {
    const std::string modified = header("last-modified");
    part_.version.changed = modified.empty() ? header("etag") : modified;
    if (status == 200 && range_.first == 0) { // the whole file is no longer than the part
        part_.version.bytes = part_.bytes.size();
        return Next::finished;
    }
    const std::string text = header("content-range");
    const auto found = parse_content_range(text);
    if (status != 206 || !found || found->first != range_.first) {
        return Error{fmt::format("the server answers {} with the part '{}', bytes {}-{} were "
                                 "expected",
                                 status, text, range_.first, range_.first + range_.count - 1)};
    }
    part_.version.bytes = found->total;
    const auto expected = std::min<std::uint64_t>(range_.count, found->total - found->first);
    if (part_.bytes.size() != expected) {
        return Error{fmt::format("the server sent {} of {} bytes", part_.bytes.size(), expected)};
    }
    return Next::finished;
}

} // namespace reljef::io
