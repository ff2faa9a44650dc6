/* The inner loop of the emulated STM32F103: counts instructions, lets time pass, enters and leaves
 * interrupts. What happens less often than once in a stretch of straight code is left to the caller.
 *
 * Unicorn runs instructions only; entry and return are done here as the ARMv7-M manual (DDI 0403)
 * describes them in B1.5.6 and B1.5.8, for one stack and one priority. */
#include <stdbool.h>
#include <stdint.h>
#include <unicorn/unicorn.h>

#define FLASH_START UINT64_C(0x08000000)
#define LONG_INSTRUCTION 0xE800 /* halfwords from here on begin one of 32 bits (DDI 0403, A5.1) */
#define IT_STATE 0x0600FC00
#define XPSR_ALIGNED (1U << 9)
#define STKALIGN (1U << 9)
#define FIRST_INTERRUPT 16
#define HARD_FAULT 3
#define RETURN_TO_THREAD 0xFFFFFFF9U
#define EXCEPTION_RETURN 8
#define FRAME_WORDS 8
#define FRAME_BYTES 32U
#define NOTHING_ACTIVE (-1)
#define FAULT_ACTIVE 63 /* the handler of faults, which no interrupt interrupts */
#define REGIONS 4
#define RAM_START UINT64_C(0x20000000)
#define THUMB_STATE 0x01000000U

/* Why hk_core_run came back: Outcome in core.py. */
enum { REACHED, SLEEPS, FAILED, FAULTS, EXCEPTS, RESTARTS, BEGINS_AGAIN, NO_CODE };

typedef struct core core_t;

typedef struct {
    core_t *core;
    uint64_t start;
} region_t;

/* The fields up to `write` are those of State in core.py. */
struct core {
    uint64_t now; /* ticks since the start */
    uint64_t ticks_per_instruction;
    uint64_t until;                 /* run so far */
    uint64_t wake;                  /* something may happen then */
    uint64_t stalled_until;         /* no instruction can be fetched before */
    uint64_t enabled;               /* interrupts, one bit each */
    uint64_t pending;
    uint64_t requests;              /* who asks now */
    int64_t active;                 /* number of the interrupt that runs */
    uint64_t ready;                 /* whether one is to be entered */
    uint64_t configuration;         /* SCB_CCR */
    uint64_t instructions;
    uint64_t foreign_instructions; /* those of interrupts */
    uint64_t failed;               /* a function of the caller failed */
    uint64_t begun;                /* so often the program was at its start since the reset */
    uint64_t fault;                /* error of Unicorn or exception, and where */
    uint64_t fault_address;
    uint64_t image_bytes;
    const uint16_t *image;
    void (*happen)(void); /* let happen what is due, and say when the next is */
    uint32_t (*read)(uint32_t address, uint32_t bytes);
    void (*write)(uint32_t address, uint32_t bytes, uint32_t value);
    uc_engine *uc;
    region_t region[REGIONS]; /* addresses that are the caller's */
    uint64_t regions;
    uint64_t reset_address;
    uint64_t interrupted_at;
    bool cleared; /* the stop before a block was for an interrupt */
    bool stopped;
    uint64_t outcome;
    uint64_t returns_to;
};

static const int frame_registers[FRAME_WORDS] = {
    UC_ARM_REG_R0,  UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3,
    UC_ARM_REG_R12, UC_ARM_REG_LR, UC_ARM_REG_PC, UC_ARM_REG_XPSR,
};

static uint32_t reg(core_t *core, int which)
{
    uint32_t value = 0;

    uc_reg_read(core->uc, which, &value);
    return value;
}

static void set_reg(core_t *core, int which, uint32_t value)
{
    uc_reg_write(core->uc, which, &value);
}

/* Within an IT block interrupts wait for its end. */
static bool may_interrupt(core_t *core)
{
    return (reg(core, UC_ARM_REG_PRIMASK) & 1) == 0 && (reg(core, UC_ARM_REG_XPSR) & IT_STATE) == 0;
}

static void stop(core_t *core, uint64_t outcome)
{
    core->outcome = outcome;
    core->stopped = true;
    uc_emu_stop(core->uc);
}

/* What is seen stays pending until it is entered; the one that runs may only ask again. */
static void look_at_requests(core_t *core)
{
    const uint64_t own = core->active == NOTHING_ACTIVE ? 0 : UINT64_C(1) << core->active;

    core->pending |= core->requests & ~own;
    core->ready = core->active == NOTHING_ACTIVE && (core->pending & core->enabled) != 0;
}

/* --- Blocks of straight code -------------------------------------------------------------------- */

static uint64_t length_of(const core_t *core, uint64_t address, uint32_t size)
{
    const uint16_t *place = core->image + (address - FLASH_START) / 2;
    const uint16_t *end = place + size / 2;
    uint64_t count = 0;

    while (place < end) {
        place += *place >= LONG_INSTRUCTION ? 2 : 1;
        count++;
    }
    return count;
}

/* Something may be due: let it happen, and stop before the block if an interrupt waits. */
static void look_around(core_t *core, uint64_t count)
{
    core->happen();
    if (core->stopped) {
        return;
    }
    core->cleared = core->ready && may_interrupt(core);
    if (core->cleared || core->now >= core->until) {
        core->instructions -= count; /* it will be counted again, once it is carried out */
        stop(core, REACHED);
    }
}

static void on_block(uc_engine *uc, uint64_t address, uint32_t size, void *data)
{
    core_t *core = data;
    uint64_t count;

    (void)uc;
    if (core->stopped) {
        return;
    }
    if (address < FLASH_START || address - FLASH_START + size > core->image_bytes) {
        core->fault_address = address;
        stop(core, NO_CODE);
        return;
    }
    if (address == core->reset_address && core->begun++ != 0) {
        stop(core, BEGINS_AGAIN);
        return;
    }
    if (core->now < core->stalled_until) {
        core->now = core->stalled_until;
    }
    count = length_of(core, address, size);
    core->now += count * core->ticks_per_instruction;
    core->instructions += count;
    if (core->now >= core->wake || core->ready) {
        look_around(core, count);
    }
}

/* --- Exceptions --------------------------------------------------------------------------------- */

static void on_exception(uc_engine *uc, uint32_t number, void *data)
{
    core_t *core = data;

    (void)uc;
    if (core->stopped) {
        return;
    }
    if (number == EXCEPTION_RETURN) {
        core->returns_to = reg(core, UC_ARM_REG_PC);
        stop(core, REACHED);
    } else {
        core->fault = number;
        core->fault_address = reg(core, UC_ARM_REG_PC);
        stop(core, EXCEPTS);
    }
}

static void enter(core_t *core, uint32_t exception)
{
    uint32_t frame[FRAME_WORDS];
    void *places[FRAME_WORDS];
    uint32_t stack = reg(core, UC_ARM_REG_SP);
    uint32_t handler = 0;
    int i;

    for (i = 0; i < FRAME_WORDS; i++) {
        places[i] = &frame[i];
    }
    uc_reg_read_batch(core->uc, (int *)frame_registers, places, FRAME_WORDS);
    if ((core->configuration & STKALIGN) != 0 && (stack & 4) != 0) {
        stack -= 4;
        frame[7] |= XPSR_ALIGNED;
    }
    stack -= FRAME_BYTES;
    uc_mem_write(core->uc, stack, frame, FRAME_BYTES);
    set_reg(core, UC_ARM_REG_SP, stack);
    set_reg(core, UC_ARM_REG_LR, RETURN_TO_THREAD);
    set_reg(core, UC_ARM_REG_IPSR, exception);
    uc_mem_read(core->uc, FLASH_START + 4 * exception, &handler, 4);
    set_reg(core, UC_ARM_REG_PC, handler);
}

static void enter_interrupt(core_t *core)
{
    const int number = __builtin_ctzll(core->pending & core->enabled);

    core->pending &= ~(UINT64_C(1) << number);
    core->active = number;
    core->ready = 0;
    core->interrupted_at = core->instructions;
    enter(core, FIRST_INTERRUPT + (uint32_t)number);
}

/* False if the return value is not that of the thread on the main stack. */
static bool leave_interrupt(core_t *core)
{
    uint32_t frame[FRAME_WORDS];
    uint32_t stack = reg(core, UC_ARM_REG_SP);
    int i;

    if ((core->returns_to | 1) != RETURN_TO_THREAD || core->active == NOTHING_ACTIVE) {
        return false;
    }
    uc_mem_read(core->uc, stack, frame, FRAME_BYTES);
    stack += FRAME_BYTES + ((frame[7] & XPSR_ALIGNED) != 0 ? 4U : 0U);
    set_reg(core, UC_ARM_REG_XPSR, frame[7] & ~XPSR_ALIGNED);
    for (i = 0; i < 6; i++) {
        set_reg(core, frame_registers[i], frame[i]);
    }
    set_reg(core, UC_ARM_REG_SP, stack);
    set_reg(core, UC_ARM_REG_PC, frame[6] | 1);
    core->active = NOTHING_ACTIVE;
    core->foreign_instructions += core->instructions - core->interrupted_at;
    look_at_requests(core);
    return true;
}

/* --- What the caller uses ----------------------------------------------------------------------- */

/* Find the requests that are new. */
void hk_core_update(core_t *core)
{
    look_at_requests(core);
}

/* Stop as soon as the instruction that is carried out has ended. */
void hk_core_stop(core_t *core)
{
    core->fault_address = reg(core, UC_ARM_REG_PC);
    stop(core, core->failed ? FAILED : RESTARTS);
}

/* Let the program's handler of faults take over. */
void hk_core_enter_fault(core_t *core)
{
    enter(core, HARD_FAULT);
    core->active = FAULT_ACTIVE;
    core->ready = 0;
    core->cleared = false;
}

static uint64_t on_read(uc_engine *uc, uint64_t offset, unsigned bytes, void *data)
{
    const region_t *region = data;

    (void)uc;
    return region->core->read((uint32_t)(region->start + offset), bytes);
}

static void on_write(uc_engine *uc, uint64_t offset, unsigned bytes, uint64_t value, void *data)
{
    const region_t *region = data;

    (void)uc;
    region->core->write((uint32_t)(region->start + offset), bytes, (uint32_t)value);
}

/* Leave the accesses to a region of addresses to the caller. */
int hk_core_map(core_t *core, uint32_t start, uint32_t bytes)
{
    region_t *region = &core->region[core->regions];

    if (core->regions++ >= REGIONS) {
        return UC_ERR_RESOURCE;
    }
    region->core = core;
    region->start = start;
    return (int)uc_mmio_map(core->uc, start, bytes, on_read, region, on_write, region);
}

int hk_core_open(core_t *core, uint32_t flash_bytes, uint32_t ram_bytes)
{
    uc_hook hook;
    int error = (int)uc_open(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS, &core->uc);

    error = error != 0 ? error : (int)uc_ctl_set_cpu_model(core->uc, UC_CPU_ARM_CORTEX_M3);
    error = error != 0 ? error
                       : (int)uc_mem_map(core->uc, FLASH_START, flash_bytes,
                                         UC_PROT_READ | UC_PROT_EXEC);
    error = error != 0 ? error : (int)uc_mem_map(core->uc, RAM_START, ram_bytes, UC_PROT_ALL);
    error = error != 0 ? error
                       : (int)uc_hook_add(core->uc, &hook, UC_HOOK_BLOCK, (void *)on_block, core,
                                          1, 0);
    return error != 0 ? error
                      : (int)uc_hook_add(core->uc, &hook, UC_HOOK_INTR, (void *)on_exception, core,
                                         1, 0);
}

void hk_core_close(core_t *core)
{
    uc_close(core->uc);
}

int hk_core_poke(core_t *core, uint32_t address, const void *bytes, uint32_t count)
{
    return (int)uc_mem_write(core->uc, address, bytes, count);
}

int hk_core_peek(core_t *core, uint32_t address, void *bytes, uint32_t count)
{
    return (int)uc_mem_read(core->uc, address, bytes, count);
}

/* Stand before the first instruction, as after a reset; memory stays. */
void hk_core_reset(core_t *core)
{
    uint32_t vectors[2] = {0, 0};
    int i;

    uc_mem_read(core->uc, FLASH_START, vectors, sizeof vectors);
    for (i = 0; i < 6; i++) {
        set_reg(core, frame_registers[i], 0);
    }
    set_reg(core, UC_ARM_REG_XPSR, THUMB_STATE);
    set_reg(core, UC_ARM_REG_PRIMASK, 0);
    set_reg(core, UC_ARM_REG_SP, vectors[0]);
    set_reg(core, UC_ARM_REG_PC, vectors[1]);
    core->reset_address = vectors[1] & ~1U;
    core->begun = 0;
    core->cleared = false;
    core->enabled = core->pending = core->requests = core->ready = core->configuration = 0;
    core->active = NOTHING_ACTIVE;
}

const char *hk_core_error(int number)
{
    return uc_strerror((uc_err)number);
}

static uint64_t run_stretch(core_t *core)
{
    uc_err error;

    if (core->ready && (core->cleared || may_interrupt(core))) {
        enter_interrupt(core);
    }
    core->stopped = core->cleared = false;
    core->returns_to = 0;
    core->outcome = SLEEPS; /* unless something stops it */
    error = uc_emu_start(core->uc, reg(core, UC_ARM_REG_PC) | 1, UINT32_MAX, 0, 0);
    if (error != UC_ERR_OK && !(core->stopped && core->outcome != REACHED)) {
        core->fault = (uint64_t)error;
        core->fault_address = reg(core, UC_ARM_REG_PC);
        return FAULTS;
    }
    if (core->returns_to != 0 && !leave_interrupt(core)) {
        core->fault = EXCEPTION_RETURN;
        core->fault_address = core->returns_to;
        return EXCEPTS;
    }
    return core->outcome;
}

/* Run until the time is up or until the caller is needed. */
int hk_core_run(core_t *core)
{
    uint64_t outcome = REACHED;

    while (outcome == REACHED && core->now < core->until) {
        outcome = run_stretch(core);
    }
    return (int)outcome;
}
