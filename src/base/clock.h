/* Time that only goes forward, for measuring; results never depend on it. */
#ifndef LIMNER_BASE_CLOCK_H
#define LIMNER_BASE_CLOCK_H

/* Milliseconds since some fixed moment. */
double clock_ms(void);

/* Milliseconds that all threads of this process have computed for. */
double clock_cpu_ms(void);

#endif
