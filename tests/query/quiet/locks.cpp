#include "query/quiet/locks.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>

namespace {

thread_local std::uint64_t locks_asked = 0;

// Returns the C library's function of this name. Any thread may look it up first: all find the
// same.
template <typename Function>
Function* next(Function*& found, const char* name) {
  if (found == nullptr) found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
  return found;
}

}  // namespace

namespace ist::test {
std::uint64_t locks() noexcept { return locks_asked; }
}  // namespace ist::test

extern "C" {
int pthread_mutex_lock(pthread_mutex_t* lock) noexcept {
  static decltype(pthread_mutex_lock)* real = nullptr;
  ++locks_asked;
  return next(real, "pthread_mutex_lock")(lock);
}
int pthread_mutex_trylock(pthread_mutex_t* lock) noexcept {
  static decltype(pthread_mutex_trylock)* real = nullptr;
  ++locks_asked;
  return next(real, "pthread_mutex_trylock")(lock);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  static decltype(pthread_rwlock_rdlock)* real = nullptr;
  ++locks_asked;
  return next(real, "pthread_rwlock_rdlock")(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  static decltype(pthread_rwlock_wrlock)* real = nullptr;
  ++locks_asked;
  return next(real, "pthread_rwlock_wrlock")(lock);
}
int pthread_spin_lock(pthread_spinlock_t* lock) noexcept {
  static decltype(pthread_spin_lock)* real = nullptr;
  ++locks_asked;
  return next(real, "pthread_spin_lock")(lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* lock) {
  static decltype(pthread_cond_wait)* real = nullptr;
  ++locks_asked;
  return next(real, "pthread_cond_wait")(condition, lock);
}
int sem_wait(sem_t* semaphore) {
  static decltype(sem_wait)* real = nullptr;
  ++locks_asked;
  return next(real, "sem_wait")(semaphore);
}
}
