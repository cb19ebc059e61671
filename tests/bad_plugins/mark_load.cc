// SPDX-License-Identifier: Apache-2.0
// Leaves a mark where the environment says, as soon as a library with it is loaded: what code that
// nobody asked for could do.
#include <cstdio>
#include <cstdlib>

namespace {

__attribute__((constructor)) void mark() {
  const char* file = std::getenv("GAITD_TEST_MARK");
  if (file == nullptr) return;
  if (std::FILE* out = std::fopen(file, "w")) std::fclose(out);
}

}  // namespace
