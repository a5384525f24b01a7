/* Runs a command and lets its n-th change of a file fail, or kills it there. Linux on x86-64 only.
 *
 *     inject fail|kill N COMMAND ...
 *
 * Counted are writes to ordinary files, syncs, renames, links, and making files and folders, by any thread and however they are
 * called: the command is traced, so calls that bypass the C library count too. A failing call is not made and returns
 * "no space left on device" (syncs: "input/output error").
 *
 * Exits with the command's own code; with 100 more if there was no n-th change; with 99 if it was killed at the change; with 98
 * if it died of a signal of its own; with 97 if it cannot be traced.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

#define MAX_THREADS 4096

/* What the call that a thread is in is to return instead of its result; 0 for its own result. */
static struct { pid_t thread; long result; } states[MAX_THREADS];

static int index_of(pid_t thread) {
    for (int i = 0; i < MAX_THREADS; i++) {
        if (states[i].thread == thread) return i;
        if (states[i].thread == 0) { states[i].thread = thread; return i; }
    }
    exit(97);
}

static int is_ordinary(pid_t thread, unsigned long long fd) {
    char path[64];
    struct stat found;
    snprintf(path, sizeof path, "/proc/%d/fd/%llu", thread, fd);
    return stat(path, &found) == 0 && S_ISREG(found.st_mode);
}

/* The error of a call that changes a file; 0 for all other calls. */
static long error_of(pid_t thread, const struct user_regs_struct *regs) {
    switch (regs->orig_rax) {
    case SYS_write: case SYS_pwrite64: case SYS_writev: case SYS_ftruncate:
        return is_ordinary(thread, regs->rdi) ? ENOSPC : 0;
    case SYS_fsync: case SYS_fdatasync:
        return EIO;
    case SYS_rename: case SYS_renameat: case SYS_renameat2: case SYS_link: case SYS_linkat: case SYS_mkdir: case SYS_mkdirat:
        return ENOSPC;
    case SYS_open:
        return regs->rsi & (O_CREAT | (O_TMPFILE & ~O_DIRECTORY)) ? ENOSPC : 0;
    case SYS_openat:
        return regs->rdx & (O_CREAT | (O_TMPFILE & ~O_DIRECTORY)) ? ENOSPC : 0;
    default:
        return 0;
    }
}

int main(int count, char **words) {
    if (count < 4) return 97;
    int kills = strcmp(words[1], "kill") == 0;
    long wanted = atol(words[2]), seen = 0;
    pid_t child = fork();
    if (child == 0) {
        ptrace(PTRACE_TRACEME, 0, 0, 0);
        raise(SIGSTOP);
        execvp(words[3], words + 3);
        _exit(97);
    }
    int status;
    if (waitpid(child, &status, 0) < 0) return 97;
    long options = PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK | PTRACE_O_EXITKILL;
    if (ptrace(PTRACE_SETOPTIONS, child, 0, options) < 0) return 97;
    ptrace(PTRACE_SYSCALL, child, 0, 0);
    for (;;) {
        pid_t thread = waitpid(-1, &status, __WALL);
        if (thread < 0) return 97;
        if (WIFEXITED(status) || WIFSIGNALED(status)) {
            states[index_of(thread)].result = 0;
            if (thread != child) continue;
            if (WIFSIGNALED(status)) return 98;
            return WEXITSTATUS(status) + (seen < wanted ? 100 : 0);
        }
        int signal = WSTOPSIG(status), at = index_of(thread);
        if (signal == (SIGTRAP | 0x80)) {
            struct user_regs_struct regs;
            ptrace(PTRACE_GETREGS, thread, 0, &regs);
            struct __ptrace_syscall_info info = { 0 };
            ptrace(PTRACE_GET_SYSCALL_INFO, thread, sizeof info, &info);
            if (info.op == PTRACE_SYSCALL_INFO_ENTRY) {
                long error = error_of(thread, &regs);
                if (error && ++seen == wanted) {
                    if (kills) {
                        kill(child, SIGKILL);
                        /* The process is gone when all of its threads have been waited for. */
                        while ((thread = waitpid(-1, &status, __WALL)) > 0) {
                            if (thread == child && WIFSIGNALED(status)) break;
                        }
                        return 99;
                    }
                    states[at].result = -error;
                    regs.orig_rax = (unsigned long long)-1;
                    ptrace(PTRACE_SETREGS, thread, 0, &regs);
                }
            } else if (states[at].result) {
                regs.rax = (unsigned long long)states[at].result;
                states[at].result = 0;
                ptrace(PTRACE_SETREGS, thread, 0, &regs);
            }
            signal = 0;
        } else if (signal == SIGSTOP || signal == SIGTRAP) {
            signal = 0; /* A new thread, or the event that announces it. */
        }
        ptrace(PTRACE_SYSCALL, thread, 0, signal);
    }
}
