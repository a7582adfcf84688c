#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/core/check.h"

namespace reljef {

/// A view of a rectangle of samples; rows lie `stride` elements apart. `col` grows east, `row`
/// grows south. Valid as long as its grid.
template <class T> class GridView {
public:
    GridView() = default;
    GridView(T* data, int cols, int rows, std::ptrdiff_t stride)
        : data_(data), cols_(cols), rows_(rows), stride_(stride) {}

    operator GridView<const T>() const requires(!std::is_const_v<T>) {
        return {data_, cols_, rows_, stride_};
    }

    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] bool empty() const { return cols_ == 0 || rows_ == 0; }

    T& operator()(int col, int row) const { return data_[row * stride_ + col]; }
    [[nodiscard]] std::span<T> row(int index) const {
        return {data_ + index * stride_, static_cast<std::size_t>(cols_)};
    }

    /// The sample at (col, row) clamped to the grid. Precondition: not empty.
    T& clamped(int col, int row) const {
        return (*this)(std::clamp(col, 0, cols_ - 1), std::clamp(row, 0, rows_ - 1));
    }

    /// Precondition: the window lies inside.
    [[nodiscard]] GridView window(int col, int row, int cols, int rows) const {
        check(col >= 0 && row >= 0 && cols >= 0 && rows >= 0 && cols <= cols_ - col &&
                  rows <= rows_ - row,
              "window outside its grid");
        return {data_ + row * stride_ + col, cols, rows, stride_};
    }

private:
    T* data_ = nullptr;
    int cols_ = 0;
    int rows_ = 0;
    std::ptrdiff_t stride_ = 0;
};

/// Leaves elements without a value where a container would make default ones.
template <class T> struct UnfilledAllocator : std::allocator<T> {
    UnfilledAllocator() = default;
    template <class U> UnfilledAllocator(const UnfilledAllocator<U>& /*other*/) {}

    template <class U> void construct(U* /*element*/) {
        static_assert(std::is_trivially_copyable_v<U>);
    }
};

/// A rectangle of samples, row-major. `col` grows east, `row` grows south; (0,0) is the centre of
/// the north-west sample.
template <class T> class Grid {
public:
    Grid() = default;
    /// Precondition: cols, rows >= 0.
    Grid(int cols, int rows, T fill = T{})
        : samples_(count(cols, rows), fill), cols_(cols), rows_(rows) {}
    /// Its samples have no values: write each before reading it. Threads that write to parts of it
    /// share the work of the first access to memory. Precondition: cols, rows >= 0.
    static Grid unfilled(int cols, int rows) {
        Grid grid;
        grid.samples_ = Samples(count(cols, rows));
        grid.cols_ = cols;
        grid.rows_ = rows;
        return grid;
    }

    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] bool empty() const { return samples_.empty(); }
    [[nodiscard]] std::size_t size() const { return samples_.size(); }

    T& operator()(int col, int row) { return samples_[index(col, row)]; }
    const T& operator()(int col, int row) const { return samples_[index(col, row)]; }
    [[nodiscard]] const T& clamped(int col, int row) const { return view().clamped(col, row); }

    [[nodiscard]] std::span<T> samples() { return samples_; }
    [[nodiscard]] std::span<const T> samples() const { return samples_; }
    [[nodiscard]] std::span<T> row(int index) { return view().row(index); }
    [[nodiscard]] std::span<const T> row(int index) const { return view().row(index); }

    [[nodiscard]] GridView<T> view() { return {samples_.data(), cols_, rows_, cols_}; }
    [[nodiscard]] GridView<const T> view() const { return {samples_.data(), cols_, rows_, cols_}; }

    friend bool operator==(const Grid&, const Grid&) = default;

private:
    using Samples = std::vector<T, UnfilledAllocator<T>>;

    static std::size_t count(int cols, int rows) {
        check(cols >= 0 && rows >= 0, "grid of a negative size");
        const auto samples =
            checked_product(static_cast<std::size_t>(cols), static_cast<std::size_t>(rows));
        check(samples && *samples <= Samples().max_size(), "grid larger than any memory");
        return *samples;
    }
    [[nodiscard]] std::size_t index(int col, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) +
               static_cast<std::size_t>(col);
    }

    Samples samples_;
    int cols_ = 0;
    int rows_ = 0;
};

} // namespace reljef
