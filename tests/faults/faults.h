/* The calls that tests/faults can make fail. */
#ifndef LIMNER_TESTS_FAULTS_H
#define LIMNER_TESTS_FAULTS_H

/* clang-format off */
#define ALL_CALLS                                                                                                                        \
    CALL(malloc) CALL(read) CALL(write) CALL(open) CALL(close) CALL(fsync) CALL(rename) CALL(link) CALL(mkdir) CALL(stat) CALL(mmap)     \
    CALL(fork) CALL(pipe) CALL(send) CALL(recv) CALL(pthread_create) CALL(eglInitialize) CALL(eglBindAPI) CALL(eglCreateContext) CALL(eglMakeCurrent)          \
    CALL(glCheckFramebufferStatus) CALL(glCreateShader) CALL(glCreateProgram) CALL(glGetShaderiv) CALL(glGetProgramiv)                   \
    CALL(glTexImage2D) CALL(glTexStorage2D) CALL(glBufferData) CALL(glRenderbufferStorage) CALL(glMapBufferRange)                        \
    CALL(glGetError) CALL(eglGetProcAddress)
/* clang-format on */

enum {
#define CALL(name) CALL_##name,
    ALL_CALLS
#undef CALL
        CALLS
};

#endif
