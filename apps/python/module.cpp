#include "apps/python/module.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <pybind11/pybind11.h>

PYBIND11_MODULE(_laterna, module) {
  namespace py = pybind11;
  module.doc() = "Laterna's C++ core; use `import laterna`.";
  module.attr("__version__") = LATERNA_VERSION;
  py::register_exception<laterna::InputError>(module, "InputError", PyExc_ValueError);
  module.def(
      "set_thread_count", &laterna::set_thread_count, py::arg("threads"),
      "How many threads are used from now on; 0: as many as the machine has. Results do not depend on it.");
  laterna::python::bind_scene(module);
  laterna::python::bind_capture(module);
  laterna::python::bind_decode(module);
  laterna::python::bind_calibrate(module);
  laterna::python::bind_boards(module);
  laterna::python::bind_verify(module);
  laterna::python::bind_score(module);
}
