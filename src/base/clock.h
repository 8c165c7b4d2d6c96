/* Time that only goes forward, for measuring; results never depend on it. */
#ifndef LIMNER_BASE_CLOCK_H
#define LIMNER_BASE_CLOCK_H

/* Milliseconds since some fixed moment. */
double clock_ms(void);

#endif
