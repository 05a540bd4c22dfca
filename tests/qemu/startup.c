/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What a test program needs to run on a bare Cortex-M4: vectors, start-up, and the few functions below
 * newlib. Text and the exit status leave through semihosting. Any exception ends the program with status 99.
 */
#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>

#define SYS_WRITE0 0x04u
#define SYS_EXIT_EXTENDED 0x20u
#define APPLICATION_EXIT 0x20026u

extern uint32_t target_data_load[], target_data[], target_data_end[], target_bss[], target_bss_end[],
    target_heap[], target_heap_end[], target_stack[];
int main(void);
void Reset_Handler(void);

static void call_host(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

void _exit(int status) __attribute__((noreturn));
void _exit(int status)
{
    uint32_t block[2] = {APPLICATION_EXIT, (uint32_t)status};
    for (;;) {
        call_host(SYS_EXIT_EXTENDED, block);
    }
}

static void exception(void)
{
    call_host(SYS_WRITE0, "\nexception\n");
    _exit(99);
}

void Reset_Handler(void)
{
    memcpy(target_data, target_data_load, (size_t)((char *)target_data_end - (char *)target_data));
    memset(target_bss, 0, (size_t)((char *)target_bss_end - (char *)target_bss));
    int status = main();
    _exit(status);
}

typedef void (*vector)(void);
__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    (vector)(uintptr_t)target_stack,
    Reset_Handler,
    exception,
    exception,
    exception,
    exception,
    exception,
    0,
    0,
    0,
    0,
    exception,
    exception,
    0,
    exception,
    exception,
};

/* ---- below newlib ------------------------------------------------------------------------------------ */

int _write(int file, const char *data, int length);
int _read(int file, char *data, int length);
int _close(int file);
int _fstat(int file, struct stat *status);
int _isatty(int file);
off_t _lseek(int file, off_t offset, int from);
void *_sbrk(ptrdiff_t more);
int _kill(int process, int signal);
int _getpid(void);

int _write(int file, const char *data, int length)
{
    char piece[65];
    (void)file;
    for (int done = 0; done < length;) {
        int now = length - done < 64 ? length - done : 64;
        memcpy(piece, data + done, (size_t)now);
        piece[now] = '\0';
        call_host(SYS_WRITE0, piece);
        done += now;
    }
    return length;
}

void *_sbrk(ptrdiff_t more)
{
    static char *end = (char *)target_heap;
    char *was = end;
    if (more > (char *)target_heap_end - end) {
        errno = ENOMEM;
        return (void *)-1;
    }
    end += more;
    return was;
}

int _read(int file, char *data, int length)
{
    (void)file;
    (void)data;
    (void)length;
    return 0;
}

int _close(int file)
{
    (void)file;
    return 0;
}

int _fstat(int file, struct stat *status)
{
    (void)file;
    status->st_mode = S_IFCHR;
    return 0;
}

int _isatty(int file)
{
    (void)file;
    return 1;
}

off_t _lseek(int file, off_t offset, int from)
{
    (void)file;
    (void)offset;
    (void)from;
    return 0;
}

int _kill(int process, int signal)
{
    (void)process;
    _exit(signal);
}

int _getpid(void)
{
    return 1;
}
