/* Driver of the MPU-6050: samples from the FIFO.
 *
 * First the status is read, which lets INT fall, then the samples in the FIFO are counted, then the
 * registers that give them their meaning are read back: samples that were counted before the
 * registers were found right are right. They are taken one by one, some before the next count. */
#include "hk_hal.h"
#include "hk_mpu6050_parts.h"

#if HK_FIFO

#define HK_PACKET_BYTES  HK_MPU6050_BURST_BYTES
#define HK_FIFO_PACKETS  (HK_MPU6050_FIFO_BYTES / HK_PACKET_BYTES)
#define HK_FIFO_MARGIN   2U /* packets: that is how far an overflow is kept away */
#define HK_BATCH         8U
#define HK_RETRY_GAP_US  (1U * HK_MS)
/* An announcement is of use for the time stamps unless it is of a sample so far behind. */
#define HK_BEHIND_MAX    4U
#define HK_RESETS_MAX    5U
/* 3 degC from one sample to the next are no temperature. */
#define HK_TEMPERATURE_JUMP 1024L
#define HK_TEMPERATURE_PLACE 6U

bool hk_mpu6050_has_work(const hk_mpu6050_t *sensor)
{
    return sensor->owed || sensor->overdue || sensor->polling || sensor->failures > 0U
           || sensor->fifo.reset_due || sensor->fifo.taken < sensor->fifo.counted;
}

static void forget(hk_mpu6050_fifo_t *fifo)
{
    fifo->counted = 0U;
    fifo->taken = 0U;
    fifo->left = 0U;
    fifo->crooked = false;
    fifo->uncounted = false;
    fifo->reset_due = false;
    fifo->count_us = hk_hal_time_us();
}

/* Empty the FIFO and let samples in again. FIFO_RESET acts only while the FIFO is off. */
static bool reset_fifo(hk_mpu6050_t *sensor, uint32_t now_us)
{
    const uint8_t interrupts = HK_INT_DATA_READY | HK_INT_FIFO_OVERFLOW;
    uint8_t stale = 0U;

    sensor->fifo.reset_due = true;
    if (!hk_mpu6050_set(sensor, HK_REG_FIFO_EN, 0U, now_us)
        || !hk_mpu6050_set(sensor, HK_REG_USER_CTRL, 0U, now_us)
        || !hk_mpu6050_set(sensor, HK_REG_USER_CTRL, HK_USER_FIFO_RESET, now_us)
        || !hk_mpu6050_get(sensor, HK_REG_INT_STATUS, &stale, 1U, now_us)
        || !hk_mpu6050_set(sensor, HK_REG_USER_CTRL, HK_USER_FIFO, now_us)
        || !hk_mpu6050_set(sensor, HK_REG_INT_ENABLE, interrupts, now_us)
        || !hk_mpu6050_set(sensor, HK_REG_FIFO_EN, HK_FIFO_ALL, now_us)) {
        return false;
    }
    forget(&sensor->fifo);
    sensor->since_us = now_us; /* new samples have their time */
    return true;
}

bool hk_mpu6050_begin_samples(hk_mpu6050_t *sensor, uint32_t now_us)
{
    sensor->fifo.resets = 0U;
    sensor->fifo.temperature_known = false;
    return reset_fifo(sensor, now_us);
}

/* Empty it because of a fault; if that does not help, begin again. */
static void repair_fifo(hk_mpu6050_t *sensor, uint32_t now_us)
{
    if (sensor->fifo.resets == HK_RESETS_MAX) {
        hk_mpu6050_begin_again(sensor, HK_MPU6050_SILENT, now_us);
    } else if (reset_fifo(sensor, now_us)) {
        sensor->fifo.resets++;
    }
}

/* What is in the FIFO cannot be used: empty it with the next step. */
static void give_up(hk_mpu6050_t *sensor, hk_mpu6050_kind_t kind, uint32_t now_us)
{
    hk_mpu6050_count_error(sensor, kind);
    sensor->since_us = now_us; /* it is not silent */
    sensor->fifo.left = 0U;
    sensor->fifo.reset_due = true;
}

/* Set the clock of the samples by the time of an announcement. It is of the first sample after the
 * status was read last, hence behind those that were counted then, or of the last of these. */
static void set_clock(hk_mpu6050_t *sensor, uint32_t announced_us)
{
    hk_mpu6050_fifo_t *fifo = &sensor->fifo;
    uint8_t behind = (uint8_t)(fifo->counted - fifo->taken);

    if ((int32_t)(announced_us - fifo->count_us) > 0) {
        behind++;
    }
    if (behind <= HK_BEHIND_MAX && !fifo->uncounted) {
        fifo->next_us = announced_us + HK_PERIOD_US - behind * HK_PERIOD_US;
    }
}

/* Whether to look into the FIFO now. */
static bool worth_looking(hk_mpu6050_t *sensor, uint32_t now_us)
{
    uint32_t time_us;

    if (hk_mpu6050_announced(sensor, &time_us)) {
        sensor->ready_us = time_us;
        sensor->owed = true;
        sensor->overdue = false;
        sensor->polling = false;
        set_clock(sensor, time_us);
    }
    if (sensor->owed || sensor->fifo.taken < sensor->fifo.counted) {
        return true;
    }
    if (!hk_mpu6050_waited(sensor, now_us, sensor->polling ? HK_POLL_US : HK_OVERDUE_US)) {
        return false;
    }
    sensor->overdue = true;
    if (now_us - sensor->poll_us < HK_POLL_GAP_US) {
        return false;
    }
    sensor->poll_us = now_us;
    return true;
}

/* Read the status, which has never all bits set. Returns whether it is one that can be. */
static bool read_status(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *status)
{
    if (!hk_mpu6050_get(sensor, HK_REG_INT_STATUS, status, 1U, now_us)) {
        return false;
    }
    if (*status == 0xFFU) {
        hk_mpu6050_fail(sensor, HK_MPU6050_TORN, now_us);
        return false;
    }
    return true;
}

/* Read the count. Returns whether it is one that can be; *bytes is then valid. */
static bool read_count(hk_mpu6050_t *sensor, uint32_t now_us, uint16_t *bytes)
{
    uint8_t count[2];

    if (!hk_mpu6050_get(sensor, HK_REG_FIFO_COUNT_H, count, sizeof count, now_us)) {
        return false;
    }
    *bytes = (uint16_t)((uint16_t)count[0] << 8 | count[1]);
    if (*bytes <= HK_MPU6050_FIFO_BYTES) {
        return true;
    }
    hk_mpu6050_fail(sensor, HK_MPU6050_TORN, now_us);
    return false;
}

/* Count the samples in the FIFO. Returns whether it holds whole ones, and none were lost. */
static bool count_packets(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *packets)
{
    hk_mpu6050_fifo_t *fifo = &sensor->fifo;
    uint16_t bytes = 0U;
    uint8_t status = 0U;

    fifo->uncounted = true;
    if (!read_status(sensor, now_us, &status) || !read_count(sensor, now_us, &bytes)) {
        return false;
    }
    if ((status & HK_INT_FIFO_OVERFLOW) != 0U || bytes == HK_MPU6050_FIFO_BYTES) {
        give_up(sensor, HK_MPU6050_OVERFLOW, now_us);
        return false;
    }
    if (bytes % HK_PACKET_BYTES != 0U) {
        if (fifo->crooked) {
            give_up(sensor, HK_MPU6050_MISALIGNED, now_us);
        } else {
            fifo->crooked = true; /* a sample may just be on its way in: count once more */
            hk_mpu6050_fail(sensor, HK_MPU6050_TRANSFER, now_us);
        }
        return false;
    }
    fifo->crooked = false;
    *packets = (uint8_t)(bytes / HK_PACKET_BYTES);
    return true;
}

/* Samples that INT has not announced; their times are those of the look. */
static void take_note_of_lost_ready(hk_mpu6050_t *sensor, uint8_t packets, uint32_t now_us)
{
    if (!sensor->polling) {
        sensor->polling = true;
        hk_mpu6050_count_error(sensor, HK_MPU6050_LOST_READY);
    }
    sensor->fifo.next_us = now_us - (packets - 1U) * HK_PERIOD_US;
}

/* Look into the FIFO. Returns whether there are samples that can be taken. */
static bool look(hk_mpu6050_t *sensor, uint32_t now_us)
{
    hk_mpu6050_fifo_t *fifo = &sensor->fifo;
    const bool expected = sensor->owed || fifo->taken < fifo->counted;
    uint8_t packets = 0U;

    sensor->owed = sensor->owed || expected; /* until all of this is done */
    if (!count_packets(sensor, now_us, &packets)) {
        return false;
    }
    fifo->counted = packets;
    fifo->taken = 0U;
    fifo->count_us = hk_hal_time_us();
    fifo->uncounted = false;
    if (!hk_mpu6050_registers_hold(sensor, now_us)) {
        return false;
    }
    sensor->owed = false;
    if (packets == 0U) {
        (void)hk_mpu6050_next_register_holds(sensor, now_us); /* why not? */
        return false;
    }
    if (!expected) {
        take_note_of_lost_ready(sensor, packets, now_us);
    }
    fifo->left = packets < HK_BATCH ? packets : HK_BATCH;
    return true;
}

/* So late the FIFO may have lost what was counted, and with it its order. */
static bool too_late(const hk_mpu6050_fifo_t *fifo, uint32_t now_us)
{
    const uint8_t room = fifo->counted + HK_FIFO_MARGIN < HK_FIFO_PACKETS
                             ? (uint8_t)(HK_FIFO_PACKETS - HK_FIFO_MARGIN - fifo->counted)
                             : 0U;

    return (int32_t)(now_us - fifo->count_us) > (int32_t)(room * HK_PERIOD_US);
}

/* An empty FIFO repeats its last byte. */
static bool is_one_byte(const uint8_t *data)
{
    uint8_t i;

    for (i = 1U; i < HK_PACKET_BYTES && data[i] == data[0]; i++) {
    }
    return i == HK_PACKET_BYTES && data[0] != 0U;
}

static int32_t temperature_of(const uint8_t *data)
{
    const uint8_t *bytes = &data[HK_TEMPERATURE_PLACE];

    return (int16_t)(uint16_t)(((uint16_t)bytes[0] << 8) | bytes[1]);
}

/* The order of the bytes shows in the temperature, which does not jump; if it does, the next one is
 * believed. */
static bool is_in_order(hk_mpu6050_t *sensor, const uint8_t *data)
{
    const int32_t jump = temperature_of(data) - temperature_of(sensor->last);
    const bool jumps = sensor->fifo.temperature_known
                       && (jump > HK_TEMPERATURE_JUMP || jump < -HK_TEMPERATURE_JUMP);

    sensor->fifo.temperature_known = !jumps;
    return !jumps && !is_one_byte(data);
}

/* Where the sensor lets go of the bus, the rest reads all ones: then some of the sample is still in
 * the FIFO. Returns whether it is not so. */
static bool was_whole(hk_mpu6050_t *sensor, const uint8_t *data, uint32_t now_us)
{
    uint16_t bytes = 0U;

    if (data[HK_PACKET_BYTES - 1U] != 0xFFU) {
        return true;
    }
    if (!read_count(sensor, now_us, &bytes)) {
        sensor->fifo.reset_due = true;
        return false;
    }
    if (bytes % HK_PACKET_BYTES == 0U) {
        return true;
    }
    give_up(sensor, HK_MPU6050_TORN, now_us);
    return false;
}

/* Take one sample. Returns whether it is one. */
static bool take(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *data)
{
    hk_mpu6050_fifo_t *fifo = &sensor->fifo;

    if (too_late(fifo, now_us)
        || !hk_mpu6050_get(sensor, HK_REG_FIFO_R_W, data, HK_PACKET_BYTES, now_us)) {
        fifo->left = 0U;
        sensor->owed = true;
        return false;
    }
    fifo->left--;
    fifo->taken++;
    if (!was_whole(sensor, data, now_us)) {
        return false;
    }
    if (!is_in_order(sensor, data)) {
        give_up(sensor, HK_MPU6050_MISALIGNED, now_us);
        return false;
    }
    return true;
}

bool hk_mpu6050_acquire(hk_mpu6050_t *sensor, uint32_t now_us, uint8_t *data, uint32_t *time_us)
{
    hk_mpu6050_fifo_t *fifo = &sensor->fifo;

    if (sensor->failures > 0U && now_us - fifo->retry_us < HK_RETRY_GAP_US) {
        return false;
    }
    if (fifo->reset_due) {
        repair_fifo(sensor, now_us);
        return false;
    }
    if (fifo->left == 0U && (!worth_looking(sensor, now_us) || !look(sensor, now_us))) {
        return false;
    }
    if (!take(sensor, now_us, data)) {
        return false;
    }
    sensor->overdue = false;
    fifo->resets = 0U;
    *time_us = fifo->next_us;
    fifo->next_us += HK_PERIOD_US;
    return true;
}

#endif
