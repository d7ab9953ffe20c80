// A bag of ROS 2 from anybody. The first byte chooses: the rest is the whole file, or a schema's text, a
// zero, and a message, which then stand several times in a file of the kind that the first byte names.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "driver.hpp"
#include "logs/convert/vehicle.hpp"
#include "logs/ros2/reader.hpp"
#include "record/writer.hpp"

namespace {

using fathom::record::Bytes;

constexpr std::array<const char*, 8> kTypes{"sensor_msgs/msg/Imu",
                                            "sensor_msgs/msg/NavSatFix",
                                            "sensor_msgs/msg/FluidPressure",
                                            "sensor_msgs/msg/MagneticField",
                                            "geometry_msgs/msg/TwistWithCovarianceStamped",
                                            "nav_msgs/msg/Odometry",
                                            "any/msg/DVL",
                                            "tf2_msgs/msg/TFMessage"};

[[noreturn]] void fail(const std::string& what) {
  (void)std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}
void expect_none(const std::string& fault) {
  if (!fault.empty()) fail(fault);
}

Bytes bag_of(std::size_t type, const std::string& text, const std::vector<std::uint8_t>& message) {
  Bytes file;
  fathom::record::WriterOptions options;
  options.compression = fathom::record::Compression::none;
  fathom::record::Writer writer(std::make_unique<fathom::record::MemorySink>(file), options);
  expect_none(writer.begin());
  const auto schema = writer.add_schema(kTypes[type], "ros2msg", text);
  const auto channel = writer.add_channel(schema, type == 7 ? "/tf_static" : "/topic", "cdr");
  for (fathom::TimeNs time = 1; time <= 4; ++time)
    expect_none(writer.write({channel, 0, time * 1'000'000'000, time * 1'000'000'000, message}));
  expect_none(writer.finish());
  return file;
}

void import(Bytes file) {
  using namespace fathom::logs;
  try {
    const Log log = ros2::read(std::make_unique<fathom::record::MemorySource>(file), "bag", {1U << 20U});
    for (const Series& series : log.series) {
      if (series.values.size() != series.rows() * series.columns.size()) fail("rows of another width");
    }
    const Vehicle vehicle = ros2_bag(log);
    const auto& imu = vehicle.data.of<fathom::ImuSample>();
    if (!std::is_sorted(imu.begin(), imu.end(), [](const auto& a, const auto& b) {
          return a.header.received_ns < b.header.received_ns;
        }))
      fail("samples out of order");
  } catch (const LogError& error) {
    if (std::string(error.what()).empty()) fail("a refusal without words");
  }
}

}  // namespace

std::string_view fathom::fuzz::target_name() {
  return "ros2";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  const std::string text =
      "std_msgs/Header header\ngeometry_msgs/Vector3 velocity\nfloat64 fom\nfloat64 altitude\nDVLBeam[] "
      "beams\n"
      "bool velocity_valid\nstring<=20 form\n===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time "
      "stamp\nstring frame_id\n"
      "===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n===\nMSG: any/DVLBeam\nint64 id\n"
      "float64 velocity\nfloat64 distance\nbool valid\n";
  const std::string one("\0\0\0\0\0\0\xF0\x3F", 8);
  std::string message("\0\1\0\0\1\0\0\0\0\0\0\0\4\0\0\0dvl\0", 20);
  for (int i = 0; i < 5; ++i) message += one;
  message += std::string("\1\0\0\0\0\0\0\0", 8);
  message += std::string(8, '\0') + one + one + std::string("\1\1\0\0\2\0\0\0j\0", 10);
  const std::string all = "\7" + text + std::string(1, '\0') + message;  // 7: a DVL's
  return {all.begin(), all.end()};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t choice = data[0] % (kTypes.size() + 1);
  if (choice == 0) {
    import(Bytes(data + 1, data + size));
    return 0;
  }
  const std::uint8_t* end = std::find(data + 1, data + size, std::uint8_t{0});
  const std::string text(reinterpret_cast<const char*>(data + 1), static_cast<std::size_t>(end - data - 1));
  const std::vector<std::uint8_t> message(end == data + size ? end : end + 1, data + size);
  import(bag_of(choice - 1, text, message));
  return 0;
}
