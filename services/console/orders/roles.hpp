#pragma once

#include "config/token_book.hpp"

namespace fathom::console {

using config::Identity;
using config::Role;
using config::TokenBook;
using config::TokenError;

}  // namespace fathom::console
