#include <dlfcn.h>

#include "tests/peers/cdd_gmp_peer.h"

namespace cguide::peers {

CddGmpFunction LoadCddGmp(const char* path) {
  void* module = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  if (module == nullptr) return nullptr;
  using Getter = void (*)(CddGmpFunction*);
  const auto get = reinterpret_cast<Getter>(dlsym(module, "cguide_cdd_gmp"));
  CddGmpFunction function = nullptr;
  if (get != nullptr) get(&function);
  return function;
}

}  // namespace cguide::peers
