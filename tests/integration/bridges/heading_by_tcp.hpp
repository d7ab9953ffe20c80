#pragma once

#include <sys/socket.h>

#include "samples/heading.hpp"
#include "support.hpp"

namespace fathom::test {

/// A heading bridge that instruments connect to.
struct HeadingByTcp {
  static constexpr int kDomain = 144;
  const TemporaryFolder folder;
  bus::Participant participant{test_participant(kDomain)};
  const Collector<HeadingSample> heading{participant};
  const int port = free_port(SOCK_STREAM);
  const Process bridge{
      "fathom-heading-bridge",
      bridge_arguments("heading", kDomain,
                       {R"(sensors.0.source={"type":"tcp_server","port":)" + std::to_string(port) + "}"}),
      folder / "log"};
};

}  // namespace fathom::test
