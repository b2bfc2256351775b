// Calls that take long: other Python threads go on meanwhile, and Ctrl-C ends them between two stages.
#pragma once

#include "apps/lab/simulation.h"

#include <pybind11/pybind11.h>

#include <string>

namespace laterna::python {

/// Throws KeyboardInterrupt (or what another signal's handler raises) where a signal waits. On the main
/// thread only, as Python has it.
inline void let_signals_through() {
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

/// Between two stages: signals, then the line for `told`, a callable or None.
inline Progress progress_to(const pybind11::object& told) {
  return [&told](const std::string& line) {
    pybind11::gil_scoped_acquire hold;
    let_signals_through();
    if (!told.is_none()) told(line);
  };
}

/// Runs `work`, which touches nothing of Python's, without the interpreter's lock.
template <class Work>
auto without_lock(Work&& work) {
  auto result = [&] {
    pybind11::gil_scoped_release release;
    return work();
  }();
  let_signals_through();
  return result;
}

}  // namespace laterna::python
