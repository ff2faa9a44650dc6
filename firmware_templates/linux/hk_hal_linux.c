/* Time, sleep and resets under Linux: see hk_hal.h and hk_linux.h. */
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "hk_design.h"
#include "hk_linux.h"

#define HK_NS_PER_S    UINT64_C(1000000000)
#define HK_NS_PER_US   1000U
#define HK_TICK_MAX_US 10000U /* longest sleep */
#define HK_TICK_US     (HK_PERIOD_US / 8U < HK_TICK_MAX_US ? HK_PERIOD_US / 8U : HK_TICK_MAX_US)
#define HK_WATCHDOG_S  2U
#define HK_BITTEN      "HK_BITTEN" /* stands in the environment after a bite */

extern char **environ;

static struct {
    uint64_t start_ns;
    hk_reset_cause_t cause;
} board;

static volatile sig_atomic_t stop_requested;

jmp_buf hk_linux_reset_vector;

uint64_t hk_linux_now_ns(void)
{
    struct timespec now;

    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * HK_NS_PER_S + (uint64_t)now.tv_nsec;
}

static void on_stop(int number)
{
    (void)number;
    stop_requested = 1;
}

/* The watchdog bites: the program starts over, with the same options. */
static void on_alarm(int number)
{
    (void)number;
    (void)execve("/proc/self/exe", hk_linux_arguments, environ);
    _exit(EXIT_FAILURE);
}

static void catch_signal(int number, void (*handler)(int))
{
    struct sigaction action = {.sa_handler = handler};
    sigset_t one;

    (void)sigemptyset(&action.sa_mask);
    (void)sigaction(number, &action, NULL);
    (void)sigemptyset(&one);
    (void)sigaddset(&one, number);
    (void)sigprocmask(SIG_UNBLOCK, &one, NULL); /* blocked if the watchdog has bitten */
}

const char *hk_linux_open(const hk_linux_options_t *options)
{
    board.cause = getenv(HK_BITTEN) == NULL ? HK_RESET_POWER : HK_RESET_WATCHDOG;
    (void)setenv(HK_BITTEN, "1", 1); /* for the program that would come after this */
    if (!hk_linux_i2c_open(options->i2c)) {
        return options->i2c;
    }
    if (options->chip != NULL && !hk_linux_gpio_open(options->chip, options->line)) {
        return options->chip;
    }
    if (!hk_linux_link_open(options->serial)) {
        return options->serial == NULL ? "standard output" : options->serial;
    }
    if (!hk_linux_store_open(options->store)) {
        return options->store;
    }
    catch_signal(SIGTERM, on_stop);
    catch_signal(SIGINT, on_stop);
    catch_signal(SIGALRM, on_alarm);
    (void)signal(SIGPIPE, SIG_IGN);
    return NULL;
}

bool hk_linux_finished(void)
{
    hk_linux_link_send();
    if (stop_requested == 0 && !hk_linux_link_broken()) {
        return false;
    }
    (void)alarm(0U);
    hk_linux_link_drain();
    return true;
}

void hk_hal_init(void)
{
    board.start_ns = hk_linux_now_ns();
    hk_hal_watchdog_feed();
}

hk_reset_cause_t hk_hal_reset_cause(void)
{
    return board.cause;
}

void hk_hal_reboot(void)
{
    board.cause = HK_RESET_REQUEST;
    longjmp(hk_linux_reset_vector, 1);
}

void hk_hal_watchdog_feed(void)
{
    (void)alarm(HK_WATCHDOG_S);
}

uint32_t hk_hal_time_us(void)
{
    return (uint32_t)((hk_linux_now_ns() - board.start_ns) / HK_NS_PER_US);
}

bool hk_hal_data_ready(uint32_t *time_us)
{
    uint64_t since_ns = board.start_ns;
    const bool high = hk_linux_gpio_high(&since_ns);

    *time_us = (uint32_t)((since_ns - board.start_ns) / HK_NS_PER_US);
    return high;
}

/* Sleep until the sensor or somebody on the link has something, or an eighth of a period. */
void hk_hal_idle(void)
{
    const struct timespec tick = {.tv_nsec = (long)(HK_TICK_US * HK_NS_PER_US)};
    struct pollfd files[] = {
        {.fd = hk_linux_gpio_events(), .events = POLLIN},
        {.fd = hk_linux_link_input(), .events = POLLIN},
        {.fd = hk_linux_link_waiting() ? hk_linux_link_output() : -1, .events = POLLOUT},
    };
    uint32_t time_us;

    if (!hk_hal_data_ready(&time_us)) {
        (void)ppoll(files, sizeof files / sizeof files[0], &tick, NULL);
    }
}

void hk_hal_mark_begin(void)
{
}

void hk_hal_mark_end(void)
{
}
