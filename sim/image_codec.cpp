#include "sim/image_codec.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

namespace laterna {

namespace {

const ImageCodec& load() {
  using Entry = const ImageCodec* (*)();
  void* module = ::dlopen("laterna_pictures.so", RTLD_NOW | RTLD_LOCAL);
  const auto entry = module ? reinterpret_cast<Entry>(::dlsym(module, "laterna_image_codec")) : nullptr;
  if (entry == nullptr)
    throw std::runtime_error(fmt::format("the module for picture files cannot be loaded: {}", ::dlerror()));
  return *entry();
}

}  // namespace

const ImageCodec& image_codec() {
  static const ImageCodec& codec = load();
  return codec;
}

}  // namespace laterna
