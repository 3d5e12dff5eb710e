/* The start of a program on a Cortex-M: its vector table, and the floating-point unit switched on. */
#include <stdint.h>

extern unsigned char stack_top[];
extern void _start(void);

static void reset(void)
{
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* full access to CP10 and CP11 */
    _start();
}

__attribute__((section(".vectors"), used)) static void *const vectors[16] = { stack_top, (void *)reset };
