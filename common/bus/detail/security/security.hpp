#pragma once

#include <cstdint>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "bus/detail/versions/names.hpp"
#include "bus/participant.hpp"
#include "security/credentials.hpp"

namespace fathom::bus::detail {

/// The lease of a participant on a protected network. It must outlast any stall of a busy machine, so it is
/// longer than without protection. When only one side gives up the other, the two cannot prove their
/// identities again: the other side counts that as done and answers no handshake (Fast DDS 2.9.1).
inline constexpr std::int32_t kProtectedLease_s = 30;

/// The checked credentials of a participant. Throws CredentialsError.
[[nodiscard]] security::Credentials credentials_of(const ParticipantOptions& options);

/// Switches Fast DDS's plugins for authentication, access control and encryption on.
void protect(dds::DomainParticipantQos& qos, const security::Credentials& credentials);

}  // namespace fathom::bus::detail
