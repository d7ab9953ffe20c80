#pragma once

namespace fathom::estimation::hydro {

/// One classical fourth-order step of dx/dt = f(x).
template <class State, class F>
[[nodiscard]] State runge_kutta(const State& x, double dt_s, const F& f) {
  const State k1 = f(x);
  const State k2 = f(State(x + 0.5 * dt_s * k1));
  const State k3 = f(State(x + 0.5 * dt_s * k2));
  const State k4 = f(State(x + dt_s * k3));
  return x + dt_s / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
}

}  // namespace fathom::estimation::hydro
