#pragma once

namespace fathom::test {

inline constexpr double kPatience_s = 60.0;  ///< with a service, on a busy machine

}  // namespace fathom::test
