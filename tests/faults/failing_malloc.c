/* Lets the n-th allocation of memory fail, for programs that use the C library's allocator (LD_PRELOAD). Linux with glibc only.
 *
 *     cc -shared -fPIC -o failing_malloc.so failing_malloc.c
 *     LD_PRELOAD=./failing_malloc.so FAILING_ALLOCATION=N COMMAND ...
 *
 * N = 0 lets none fail. How many there were is written at the end to the file named by ALLOCATIONS, if the process comes to it.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static atomic_long seen;
static long wanted;

static int fails(void) {
    if (atomic_fetch_add(&seen, 1) + 1 != wanted) return 0;
    errno = ENOMEM;
    return 1;
}

/* Allocations of the loader, before this, are not counted: their failure could not be reported. */
__attribute__((constructor)) static void begin(void) {
    const char *number = getenv("FAILING_ALLOCATION");
    wanted = number ? atol(number) : 0;
    unsetenv("LD_PRELOAD");
    atomic_store(&seen, 0);
}

__attribute__((destructor)) static void end(void) {
    const char *path = getenv("ALLOCATIONS");
    char text[32];
    int length = snprintf(text, sizeof text, "%ld\n", atomic_load(&seen));
    int file = path ? open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600) : -1;
    if (file < 0) return;
    if (write(file, text, (size_t)length) < 0) _exit(97);
    close(file);
}

void *malloc(size_t size) { return fails() ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return fails() ? NULL : __libc_calloc(count, size); }
void *realloc(void *place, size_t size) { return fails() ? NULL : __libc_realloc(place, size); }
void *memalign(size_t boundary, size_t size) { return fails() ? NULL : __libc_memalign(boundary, size); }
void *aligned_alloc(size_t boundary, size_t size) { return fails() ? NULL : __libc_memalign(boundary, size); }
int posix_memalign(void **place, size_t boundary, size_t size) {
    if (fails()) return ENOMEM;
    *place = __libc_memalign(boundary, size);
    return *place ? 0 : ENOMEM;
}
