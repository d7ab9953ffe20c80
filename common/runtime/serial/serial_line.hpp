#pragma once

#include <string>

#include <asio/io_context.hpp>
#include <asio/serial_port.hpp>

namespace fathom::runtime {

/// A serial port with 8 data bits, no parity, 1 stop bit and no flow control. Throws std::system_error.
[[nodiscard]] inline asio::serial_port open_serial_line(asio::io_context& io, const std::string& path,
                                                        int baud) {
  asio::serial_port port(io, path);
  port.set_option(asio::serial_port::baud_rate(static_cast<unsigned>(baud)));
  port.set_option(asio::serial_port::character_size(8));
  port.set_option(asio::serial_port::parity(asio::serial_port::parity::none));
  port.set_option(asio::serial_port::stop_bits(asio::serial_port::stop_bits::one));
  port.set_option(asio::serial_port::flow_control(asio::serial_port::flow_control::none));
  return port;
}

}  // namespace fathom::runtime
