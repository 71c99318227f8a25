// Lets user-mode Linux run where a processor has more registers than it knows of; scripts/lab compiles
// and preloads it there.
//
// User-mode Linux keeps 2,696 bytes of a process's extended state, up to AVX-512 and PKRU. A kernel
// that has more (AMX: 11 KB) takes and gives the state only whole, so that ptrace() ends with EFAULT and
// the machine stops. This ptrace() asks for all of it, hands on what fits, and gives the rest back as
// unused: a program in the lab cannot use AMX, and loses nothing else.
// Source: Intel SDM volume 1, 13.4 (standard format of the XSAVE area); ptrace(2), PTRACE_GETREGSET.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/uio.h>

enum {
  most_bytes = 65536,  // far above what a processor has
  xstate_bv_at = 512,  // which components follow, a bit each
};
#define KNOWN_COMPONENTS UINT64_C(0x2ff)  // x87, SSE, AVX, MPX, AVX-512, PKRU: all within 2,696 bytes

typedef long Ptrace(int, pid_t, void*, void*);

static void forget_unknown_components(unsigned char* state) {
  uint64_t components = 0;
  memcpy(&components, state + xstate_bv_at, sizeof components);
  components &= KNOWN_COMPONENTS;
  memcpy(state + xstate_bv_at, &components, sizeof components);
}

static size_t whole_bytes;  // how long a whole state is: this kernel says it with the first

static long get_state(Ptrace* real, pid_t pid, void* kind, struct iovec* asked) {
  static unsigned char state[most_bytes];
  struct iovec whole = {state, sizeof state};
  const long result = real(PTRACE_GETREGSET, pid, kind, &whole);
  if (result != 0) {
    return result;
  }
  whole_bytes = whole.iov_len;
  forget_unknown_components(state);
  if (asked->iov_len > whole_bytes) {
    asked->iov_len = whole_bytes;
  }
  memcpy(asked->iov_base, state, asked->iov_len);
  return 0;
}

// User-mode Linux sets no state before it has got one.
static long set_state(Ptrace* real, pid_t pid, void* kind, const struct iovec* given) {
  static unsigned char state[most_bytes];  // what is beyond the given stays 0
  struct iovec whole = {state, whole_bytes};
  memcpy(state, given->iov_base, given->iov_len < whole_bytes ? given->iov_len : whole_bytes);
  forget_unknown_components(state);
  return real(PTRACE_SETREGSET, pid, kind, &whole);
}

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace* real;
  if (real == NULL) {
    real = (Ptrace*)dlsym(RTLD_NEXT, "ptrace");
  }
  va_list arguments;
  va_start(arguments, request);
  const pid_t pid = va_arg(arguments, pid_t);
  void* const address = va_arg(arguments, void*);
  void* const data = va_arg(arguments, void*);
  va_end(arguments);
  if (request == PTRACE_GETREGSET && (uintptr_t)address == NT_X86_XSTATE) {
    return get_state(real, pid, address, data);
  }
  if (request == PTRACE_SETREGSET && (uintptr_t)address == NT_X86_XSTATE) {
    return set_state(real, pid, address, data);
  }
  return real((int)request, pid, address, data);
}
