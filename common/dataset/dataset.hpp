#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/name.hpp"
#include "base/time.hpp"
#include "samples/kinds.hpp"
#include "samples/truth.hpp"
#include "samples/verdict.hpp"

/// A recorded or simulated vehicle as a folder of CSV files, one per sensor, each plain or .gz. README.md
/// beside this header has the files, their columns and what a row means.
namespace fathom::dataset {

/// The folder or a file in it cannot be used. what() is "FILE:LINE: what is wrong, what was expected", or
/// "FILE: ..." where no line is to blame.
class DatasetError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The disk does not take the folder or a file of it.
class WriteError : public DatasetError {
 public:
  using DatasetError::DatasetError;
};

template <class Sample>
struct Stream {
  std::vector<Sample> samples;
};
template <class... Samples>
struct StreamsOf : Stream<Samples>... {};

/// Sensor streams in the order of their files, one a kind: `data.of<GpsSample>()`. header.sensor is the word
/// of the kind, or "reference"; header.sequence counts from 0.
struct Dataset : Kinds::Samples<StreamsOf> {
  template <OfAKind Sample>
  [[nodiscard]] std::vector<Sample>& of() {
    return Stream<Sample>::samples;
  }
  template <OfAKind Sample>
  [[nodiscard]] const std::vector<Sample>& of() const {
    return Stream<Sample>::samples;
  }
  std::vector<Truth> reference;
  /// "FILE:LINE: what is missing": of files whose ends were lost.
  std::vector<std::string> lost_ends;
};

/// The instant that t_s = 0 means where nothing else is said: 2020-01-01T00:00:00Z.
inline constexpr TimeNs kDefaultEpochNs = 1'577'836'800 * kNsPerSecond;

/// What a file of a data set may be called: imu.csv, imu.csv.gz and so on, those of the reference last.
[[nodiscard]] std::vector<std::string> file_names();

struct ReadOptions {
  TimeNs epoch_ns = kDefaultEpochNs;  ///< UTC of t_s = 0
  Name vehicle = "auv";
  /// A file that was cut is read up to there, and named in Dataset::lost_ends. Else it is refused.
  bool without_lost_ends = false;
};

/// Throws DatasetError.
[[nodiscard]] Dataset read(const std::filesystem::path& directory, const ReadOptions& options = {});

struct WriteOptions {
  TimeNs epoch_ns = kDefaultEpochNs;  ///< subtracted from every stamp to give t_s
  bool gzip = false;                  ///< NAME.csv.gz instead of NAME.csv
};

/// Writes one file per stream that is not empty into `directory`, which is created when absent; files of this
/// layout that an earlier call left there are removed. Numbers are written so that reading gives the same
/// value back (angles to the rounding of their conversion to degrees); optional columns only where some row
/// knows them; t_received_s only where some sample did not arrive at its stamp. Throws WriteError.
void write(const std::filesystem::path& directory, const Dataset& data, const WriteOptions& options = {});

/// One sample of a Dataset in the order of arrival: the element `index` of the stream `source`.
struct Arrival {
  TimeNs received_ns = 0;
  SourceKind source = SourceKind::imu;
  std::uint32_t index = 0;
};

/// All sensor samples (not the reference) by received_ns; at equal instants in the order of SourceKind (the
/// inertial sample first), then of the file.
[[nodiscard]] std::vector<Arrival> arrivals(const Dataset& data);

/// Calls `consumer` with the sample that `arrival` names.
template <class Consumer>
void visit(const Dataset& data, const Arrival& arrival, Consumer&& consumer) {
  for_each_kind([&](auto kind) {
    if (kind.kSource == arrival.source)
      consumer(data.of<typename decltype(kind)::Sample>()[static_cast<std::size_t>(arrival.index)]);
  });
}

}  // namespace fathom::dataset
