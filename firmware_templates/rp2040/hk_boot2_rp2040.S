/* The second-stage loader: makes the flash readable, then starts the program in it.
 *
 * The boot ROM copies these 256 bytes from the start of the flash to the end of the RAM, checks
 * their CRC and jumps to the first with a link register of 0. Whoever calls a copy as a function,
 * after the flash was changed, gets it back readable. The code must not care where it runs. It
 * changes r0 to r3 only. The flash is read with the plain command 03h, one bit wide, which every
 * SPI flash of a Pico-like board knows. */
    .syntax unified
    .cpu cortex-m0plus
    .thumb

    .equ SSI,       0x18000000
    .equ VTOR,      0xE000ED08
    .equ VECTORS,   0x10000100

/* Registers of the SSI, as distances from its base. */
    .equ CTRLR0,    0x00
    .equ CTRLR1,    0x04
    .equ SSIENR,    0x08
    .equ SER,       0x10
    .equ BAUDR,     0x14
    .equ SPI_CTRL,  0xF4

    .equ DIVIDER,   4               /* 31.25 MHz at 125 MHz; 03h is good for 50 MHz */
    .equ FRAME_32,  31 << 16        /* data frames of 32 bits */
    .equ EEPROM,    3 << 8          /* send command and address, then receive */
    .equ COMMAND,   0x03 << 24
    .equ COMMAND_8, 2 << 8          /* the command has 8 bits */
    .equ ADDRESS,   6 << 2          /* the address has 6 nibbles */

    .section .boot2, "ax", %progbits
    .balign 4
    .global hk_boot2
    .type hk_boot2, %function
    .thumb_func
hk_boot2:
    ldr  r0, =SSI
    adr  r1, settings
next:
    ldmia r1!, {r2, r3}
    str  r3, [r0, r2]
    adr  r2, settings_end
    cmp  r1, r2
    bne  next
    mov  r0, lr
    cmp  r0, #0
    beq  start
    bx   lr

start:
    ldr  r0, =VECTORS
    ldr  r1, =VTOR
    str  r0, [r1]
    ldmia r0, {r0, r1}              /* initial stack pointer, reset vector */
    msr  msp, r0
    bx   r1

    .balign 4
settings:
    .word SSIENR,   0
    .word BAUDR,    DIVIDER
    .word CTRLR0,   FRAME_32 | EEPROM
    .word CTRLR1,   0
    .word SPI_CTRL, COMMAND | COMMAND_8 | ADDRESS
    .word SER,      1
    .word SSIENR,   1
settings_end:
    .ltorg
    .size hk_boot2, . - hk_boot2
