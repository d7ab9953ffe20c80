#pragma once

namespace fathom::test {

/// Under a sanitizer everything takes many times as long: tests that would take hours do part of their work.
#ifdef FATHOM_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace fathom::test
