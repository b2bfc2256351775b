#include "tests/gl/context.h"

#include "tests/gl/opengl.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

namespace laterna::gl {

// OSMesa wants a picture of its own to draw into; everything here is drawn into framebuffer objects.
struct Context::State {
  OSMesaContext context = nullptr;
  std::array<unsigned char, 4 * 4 * 4> picture{};
};

Context::Context(Profile profile) : state_(std::make_unique<State>()) {
  const bool core = profile == Profile::core;
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            core ? OSMESA_CORE_PROFILE : OSMESA_COMPAT_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            core ? 3 : 2,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            core ? 3 : 1,
                            0};
  state_->context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!state_->context) throw std::runtime_error("OSMesa gives no OpenGL");
  if (!OSMesaMakeCurrent(state_->context, state_->picture.data(), GL_UNSIGNED_BYTE, 4, 4)) {
    OSMesaDestroyContext(state_->context);
    throw std::runtime_error("OSMesa's OpenGL cannot be made current");
  }
}

Context::~Context() {
  OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(state_->context);
}

std::string Context::name() const {
  const auto text = [](GLenum what) { return reinterpret_cast<const char*>(glGetString(what)); };
  return fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
}

void check_errors(const char* after) {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw std::runtime_error(fmt::format("OpenGL error 0x{:x} after {}", error, after));
}

}  // namespace laterna::gl
