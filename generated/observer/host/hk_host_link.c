/* The link of the host program: see the header. */
#include "hk_host_link.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define HK_OUTPUT_BYTES 4096U
#define HK_INPUT_BYTES  256U
#define HK_NS_PER_S     1e9

static struct {
    uint8_t *script;      /* the file, or NULL */
    size_t script_bytes;
    size_t script_place;  /* of the next byte */
    size_t piece_end;     /* of the piece it belongs to */
    uint64_t piece_ns;
    bool listening;
    uint8_t input[HK_INPUT_BYTES];
    size_t input_bytes;
    size_t input_place;
    uint8_t output[HK_OUTPUT_BYTES];
    size_t output_bytes;
} host_link;

/* Go to the next piece of the script that is not empty. */
static void next_piece(void)
{
    double time_s;
    uint32_t count;

    while (host_link.script_place == host_link.piece_end) {
        if (host_link.script_bytes - host_link.script_place < sizeof time_s + sizeof count) {
            host_link.script_place = host_link.script_bytes;
            host_link.piece_end = host_link.script_bytes;
            host_link.piece_ns = UINT64_MAX;
            return;
        }
        (void)memcpy(&time_s, &host_link.script[host_link.script_place], sizeof time_s);
        host_link.script_place += sizeof time_s;
        (void)memcpy(&count, &host_link.script[host_link.script_place], sizeof count);
        host_link.script_place += sizeof count;
        host_link.piece_ns = (uint64_t)(time_s * HK_NS_PER_S);
        host_link.piece_end = host_link.script_bytes - host_link.script_place < count
                             ? host_link.script_bytes
                             : host_link.script_place + count;
    }
}

static bool read_whole(FILE *file)
{
    long size;

    if (fseek(file, 0, SEEK_END) != 0 || (size = ftell(file)) < 0) {
        return false;
    }
    rewind(file);
    host_link.script_bytes = (size_t)size;
    host_link.script = malloc(host_link.script_bytes + 1U);
    return host_link.script != NULL
           && fread(host_link.script, 1U, host_link.script_bytes, file) == host_link.script_bytes;
}

bool hk_host_link_play(const char *path)
{
    FILE *file = path == NULL ? NULL : fopen(path, "rb");
    const bool good = path == NULL || (file != NULL && read_whole(file));

    if (file != NULL) {
        (void)fclose(file);
    }
    next_piece();
    return good;
}

void hk_host_link_listen(void)
{
    const int flags = fcntl(STDIN_FILENO, F_GETFL);

    host_link.listening = flags >= 0 && fcntl(STDIN_FILENO, F_SETFL, flags | O_NONBLOCK) == 0;
}

uint64_t hk_host_link_next_ns(void)
{
    return host_link.piece_ns;
}

static bool take_input(uint8_t *byte)
{
    if (host_link.input_place == host_link.input_bytes) {
        const ssize_t count = read(STDIN_FILENO, host_link.input, HK_INPUT_BYTES);

        host_link.input_place = 0U;
        host_link.input_bytes = count > 0 ? (size_t)count : 0U;
        if (count == 0) {
            host_link.listening = false; /* nobody talks any more */
        }
    }
    if (host_link.input_place == host_link.input_bytes) {
        return false;
    }
    *byte = host_link.input[host_link.input_place++];
    return true;
}

bool hk_host_link_take(uint64_t now_ns, uint8_t *byte)
{
    if (host_link.listening) {
        return take_input(byte);
    }
    if (host_link.piece_ns > now_ns) {
        return false;
    }
    *byte = host_link.script[host_link.script_place++];
    next_piece();
    return true;
}

void hk_host_link_drop(uint64_t now_ns)
{
    uint8_t byte;

    while (hk_host_link_take(now_ns, &byte)) {
    }
}

void hk_host_link_put(const uint8_t *bytes, uint8_t count)
{
    if (host_link.output_bytes + count > HK_OUTPUT_BYTES) {
        (void)hk_host_link_flush();
    }
    (void)memcpy(&host_link.output[host_link.output_bytes], bytes, count);
    host_link.output_bytes += count;
}

bool hk_host_link_flush(void)
{
    size_t done = 0U;

    while (done < host_link.output_bytes) {
        const ssize_t written =
            write(STDOUT_FILENO, &host_link.output[done], host_link.output_bytes - done);

        if (written > 0) {
            done += (size_t)written;
        } else if (written < 0 && errno != EINTR) {
            host_link.output_bytes = 0U;
            return false;
        }
    }
    host_link.output_bytes = 0U;
    return true;
}
