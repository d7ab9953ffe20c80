#pragma once

namespace fathom::commission {

/// Log likelihood ratio from which a hypothesis is refuted: e^-15 in some 400 of them is no chance.
inline constexpr double kReject = 15.0;

}  // namespace fathom::commission
