/* What happens in a window, one line an event with the monotonic time in microseconds, for tests and for measuring:
 * written to the file descriptor that the environment names in LIMNER_VIEW_TRACE. With LIMNER_VIEW_HEARTBEAT it also
 * tells when the main loop did not come round for 20 ms. */
#ifndef LIMNER_VIEW_TRACE_H
#define LIMNER_VIEW_TRACE_H

void trace_begin(void);
void trace_event(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
