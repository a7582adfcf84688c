#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <mutex>
#include <utility>

#include "engine/io/raster/gdal_dataset.h"

namespace reljef::io {

/// Rasters that stay open from one reading to the next, a few at most, for any number of threads:
/// what one has borrowed nobody else uses.
class DatasetPool {
public:
    /// Rasters that stay open while nobody reads them, at most.
    static constexpr std::size_t max_idle = 32;

    using Opener =
        std::function<Result<Dataset>(const std::filesystem::path&, const GdalMessages&)>;
    explicit DatasetPool(Opener open = open_raster) : open_(std::move(open)) {}

    /// Changes if a file is no longer the one that was opened; the same for all files on servers.
    struct FileState {
        std::filesystem::file_time_type changed;
        std::uintmax_t bytes = 0;
        friend bool operator==(const FileState&, const FileState&) = default;
    };

    /// An open raster, for the scope.
    class Loan {
    public:
        /// `opened` is what the file was before it was opened.
        Loan(DatasetPool& pool, std::filesystem::path path, FileState opened, Dataset dataset)
            : pool_(&pool), path_(std::move(path)), opened_(opened), dataset_(std::move(dataset)) {}
        ~Loan();
        Loan(Loan&&) = default;
        Loan& operator=(Loan&&) = delete;

        GDALDataset& operator*() const { return *dataset_; }
        GDALDataset* operator->() const { return dataset_.get(); }
        /// It is closed, and nothing of it kept: for one that failed.
        void spoil();

    private:
        DatasetPool* pool_;
        std::filesystem::path path_;
        FileState opened_;
        Dataset dataset_;
    };

    /// What is to be made of a file that was opened just now.
    using Check = std::function<Result<Dataset>(Dataset)>;

    /// Opens the file where none of it is idle, or where it has changed since that was opened.
    /// Fails as the opener, or `check`.
    Result<Loan> borrow(const std::filesystem::path& path, const GdalMessages& messages,
                        const Check& check = {});

private:
    struct Idle {
        std::filesystem::path path;
        FileState opened;
        Dataset dataset;
    };
    void give_back(Idle idle);

    const Opener open_;
    std::mutex mutex_;
    std::list<Idle> idle_; // the latest first
};

} // namespace reljef::io
