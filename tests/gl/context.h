// A headless OpenGL: Mesa's software rasteriser (OSMesa). Unlike EGL it needs no device, no display and no
// driver to be found at run time: one library that is always the software one, on any machine.
#pragma once

#include <memory>
#include <string>

namespace laterna::gl {

enum class Profile {
  core,          ///< OpenGL 3.3
  compatibility  ///< with the fixed-function pipeline
};

/// An OpenGL that is current on this thread from its making to its end. What is made in it (textures,
/// buffers, programs: bare names) goes with it. One at a time on a thread. Throws std::runtime_error where
/// Mesa gives none.
class Context {
 public:
  explicit Context(Profile profile = Profile::core);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Mesa's version and rasteriser, for people.
  std::string name() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws std::runtime_error, with OpenGL's code and `after`, where an error has come up since the last call.
void check_errors(const char* after);

}  // namespace laterna::gl
