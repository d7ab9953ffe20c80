#include "launch/life_signs.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <system_error>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace fathom::launch {
namespace {

[[noreturn]] void fail(int socket) {
  const int error = errno;
  if (socket >= 0) close(socket);
  throw std::system_error(error, std::generic_category(), "no socket for life signs");
}

}  // namespace

LifeSigns::LifeSigns() : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const int on = 1;
  sockaddr_un own{};
  own.sun_family = AF_UNIX;
  // Without a name the kernel gives one that nobody else has.
  if (socket_ < 0 || setsockopt(socket_, SOL_SOCKET, SO_PASSCRED, &on, sizeof on) != 0 ||
      bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own.sun_family) != 0)
    fail(socket_);
  socklen_t size = sizeof own;
  if (getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size) != 0) fail(socket_);
  const std::size_t head = offsetof(sockaddr_un, sun_path) + 1;  // the name begins with a zero byte
  variable_ = "NOTIFY_SOCKET=@" + std::string(own.sun_path + 1, size - head);
}

LifeSigns::~LifeSigns() {
  close(socket_);
}

std::set<pid_t> LifeSigns::heard() {
  std::set<pid_t> out;
  while (true) {
    std::array<char, 512> text{};
    iovec part{text.data(), text.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> beside{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = beside.data();
    message.msg_controllen = beside.size();
    const ssize_t got = recvmsg(socket_, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return out;
    for (const cmsghdr* one = CMSG_FIRSTHDR(&message); one != nullptr;
         one = CMSG_NXTHDR(&message, const_cast<cmsghdr*>(one))) {
      if (one->cmsg_level != SOL_SOCKET || one->cmsg_type != SCM_CREDENTIALS) continue;
      ucred who{};
      std::memcpy(&who, CMSG_DATA(one), sizeof who);
      out.insert(who.pid);
    }
  }
}

}  // namespace fathom::launch
