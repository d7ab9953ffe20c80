#pragma once

#include <cstdint>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "bus/detail/versions/names.hpp"
#include "bus/participant.hpp"
#include "security/credentials.hpp"

namespace fathom::bus::detail {

/// How long a participant's word that it is there holds. Longer than without protection: one that is given up
/// by one side only cannot prove its identity to it again, because the other holds that done already and
/// answers no handshake (Fast DDS 2.9.1). It must outlast any stall of a busy machine.
inline constexpr std::int32_t kProtectedLease_s = 30;

/// The checked credentials of a participant. Throws CredentialsError.
[[nodiscard]] security::Credentials credentials_of(const ParticipantOptions& options);

/// Switches Fast DDS's plugins for authentication, access control and encryption on.
void protect(dds::DomainParticipantQos& qos, const security::Credentials& credentials);

}  // namespace fathom::bus::detail
