/* SPDX-License-Identifier: Apache-2.0 */
/* The program itself: pipes, scripts, exit statuses, awkward bytes. */
#include "bqsim.h"
#include "unity.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char output[2 * BQSIM_LINE_MAX];
static char folder[] = "/tmp/bqsim-test-XXXXXX";

void setUp(void)
{
}

void tearDown(void)
{
}

static const char *in_folder(const char *name)
{
    static char path[2][80];
    static int turn;

    turn = !turn;
    (void)snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static void write_file(const char *name, const void *data, size_t n)
{
    FILE *f = fopen(in_folder(name), "wb");

    TEST_ASSERT_NOT_NULL(f);
    TEST_ASSERT_EQUAL(n, fwrite(data, 1, n, f));
    TEST_ASSERT_EQUAL(0, fclose(f));
}

/* Runs `bqsim ARGUMENTS` in the folder through the shell; replies in output, returns the exit status. */
static int run(const char *arguments)
{
    char command[600];
    FILE *p;
    size_t n;
    int status;

    (void)snprintf(command, sizeof command, "cd %s && '%s' %s", folder, BQSIM, arguments);
    p = popen(command, "r");
    TEST_ASSERT_NOT_NULL(p);
    n = fread(output, 1, sizeof output - 1, p);
    output[n] = '\0';
    status = pclose(p);
    TEST_ASSERT_TRUE_MESSAGE(WIFEXITED(status), "bqsim crashed");
    return WEXITSTATUS(status);
}

static int script(const void *text, size_t n)
{
    write_file("script", text, n);
    return run("script");
}

static void test_replies_and_status_0(void)
{
    static const char text[] =
        "# two devices\n\nstack 2\nspi 01 3b 01 02\nspi 02 3b 01 00 00\nget dev.2.mode\nquit\nhello\n";
    static const char replies[] = "ok\nok -- -- -- --\nok -- -- -- 81 ba\nok active\nok\n";

    TEST_ASSERT_EQUAL(0, script(text, sizeof text - 1));
    TEST_ASSERT_EQUAL_STRING(replies, output);
    TEST_ASSERT_EQUAL(0, run("<script"));
    TEST_ASSERT_EQUAL_STRING(replies, output);
}

static void test_status_1_when_a_command_was_refused(void)
{
    static const char text[] = "stack 1\nhello\nget dev.1.mode\nquit\n";

    TEST_ASSERT_EQUAL(1, script(text, sizeof text - 1));
    TEST_ASSERT_EQUAL_STRING("ok\nerr unknown command: hello\nok active\nok\n", output);
}

static void test_status_2_when_the_script_cannot_be_read(void)
{
    TEST_ASSERT_EQUAL(2, run("none 2>&1 >replies"));
    TEST_ASSERT_NOT_NULL(strstr(output, "none"));
    TEST_ASSERT_EQUAL(2, run(". 2>&1 >replies"));
    TEST_ASSERT_EQUAL(2, run("<. 2>&1 >replies"));
    TEST_ASSERT_EQUAL(2, run("--vcd 2>&1"));
    TEST_ASSERT_NOT_NULL(strstr(output, "usage"));
    TEST_ASSERT_EQUAL(2, run("--nothing 2>&1"));
    TEST_ASSERT_EQUAL(2, run("script script 2>&1"));
    TEST_ASSERT_EQUAL(2, run("--vcd no/such/folder/w.vcd </dev/null 2>&1"));
}

static void test_empty_input_is_accepted(void)
{
    TEST_ASSERT_EQUAL(0, run("</dev/null"));
    TEST_ASSERT_EQUAL_STRING("", output);
    TEST_ASSERT_EQUAL(0, script("# nothing\n\n \n", 13));
    TEST_ASSERT_EQUAL_STRING("", output);
}

static void test_crlf_and_a_last_line_without_end(void)
{
    static const char text[] = "stack 1\r\n\r\nget pin.conv\r\nget dev.1.supply";

    TEST_ASSERT_EQUAL(0, script(text, sizeof text - 1));
    TEST_ASSERT_EQUAL_STRING("ok\nok 0\nok on\n", output);
}

static void test_nul_bytes(void)
{
    static const char text[] = "stack 1\nget pin.conv\0junk\n\0\nget pin.conv\n# \0\nget pin.conv\n";

    TEST_ASSERT_EQUAL(1, script(text, sizeof text - 1));
    TEST_ASSERT_EQUAL_STRING("ok\nerr NUL in line\nerr unknown command: ?\nok 0\nok 0\n", output);
}

static void test_overlong_lines_get_one_reply(void)
{
    size_t n = 400000;
    char *text = malloc(n);
    size_t at;

    TEST_ASSERT_NOT_NULL(text);
    memcpy(text, "stack 1\nspi", 11);
    at = 11;
    while (at < 65536) {
        memcpy(&text[at], " 00", 3);
        at += 3;
    }
    text[at++] = '\n';
    memset(&text[at], 'x', 300000);
    at += 300000;
    memcpy(&text[at], "\nget pin.conv\n", 14);
    at += 14;
    TEST_ASSERT_EQUAL(1, script(text, at));
    free(text);
    TEST_ASSERT_EQUAL_STRING("ok\nok -- -- -- 00", (output[17] = '\0', output));
    TEST_ASSERT_NOT_NULL(strstr(&output[18], "--\nerr line too long\nok 0\n"));
}

static void test_each_reply_is_flushed_before_the_next_command_is_read(void)
{
    int to[2], from[2];
    char reply[64];
    pid_t child;
    int status;

    TEST_ASSERT_EQUAL(0, pipe(to));
    TEST_ASSERT_EQUAL(0, pipe(from));
    child = fork();
    TEST_ASSERT_TRUE(child >= 0);
    if (child == 0) {
        (void)dup2(to[0], 0);
        (void)dup2(from[1], 1);
        (void)close(to[1]);
        (void)close(from[0]);
        (void)execl(BQSIM, "bqsim", (char *)NULL);
        _exit(99);
    }
    (void)close(to[0]);
    (void)close(from[1]);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(8, write(to[1], "stack 1\n", 8));
        TEST_ASSERT_EQUAL(3,
                          read(from[0], reply, sizeof reply)); /* would wait for ever if it were buffered */
        TEST_ASSERT_EQUAL_MEMORY("ok\n", reply, 3);
    }
    (void)close(to[1]);
    TEST_ASSERT_EQUAL(child, waitpid(child, &status, 0));
    TEST_ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    (void)close(from[0]);
}

static void test_replies_that_cannot_be_written_end_in_status_1(void)
{
    if (access("/dev/full", W_OK) != 0) {
        TEST_IGNORE_MESSAGE("needs /dev/full");
    }
    write_file("script", "stack 1\nget pin.conv\n", 21);
    TEST_ASSERT_EQUAL(1, run("script >/dev/full 2>&1"));
}

static void test_vcd_file_is_written_and_its_failure_is_status_1(void)
{
    static const char text[] =
        "stack 1\nspi 00 00 01 00 00\nadvance 1ms\nset pin.conv 1\nadvance 1ms\nset pin.conv 0\n";

    write_file("script", text, sizeof text - 1);
    TEST_ASSERT_EQUAL(0, run("--vcd w.vcd script && cat w.vcd"));
    TEST_ASSERT_NOT_NULL(strstr(output, "$enddefinitions"));
    TEST_ASSERT_NOT_NULL(strstr(output, "$timescale"));
    TEST_ASSERT_EQUAL(0, run("script --vcd v.vcd && cmp v.vcd w.vcd"));
    if (access("/dev/full", W_OK) == 0) {
        TEST_ASSERT_EQUAL(1, run("--vcd /dev/full script 2>&1 >replies"));
    }
}

static void remove_folder(void)
{
    static const char *const names[] = {"script", "replies", "w.vcd", "v.vcd"};

    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        (void)unlink(in_folder(names[i]));
    }
    (void)rmdir(folder);
}

int main(void)
{
    if (mkdtemp(folder) == NULL) {
        return 1;
    }
    UNITY_BEGIN();
    RUN_TEST(test_replies_and_status_0);
    RUN_TEST(test_status_1_when_a_command_was_refused);
    RUN_TEST(test_status_2_when_the_script_cannot_be_read);
    RUN_TEST(test_empty_input_is_accepted);
    RUN_TEST(test_crlf_and_a_last_line_without_end);
    RUN_TEST(test_nul_bytes);
    RUN_TEST(test_overlong_lines_get_one_reply);
    RUN_TEST(test_each_reply_is_flushed_before_the_next_command_is_read);
    RUN_TEST(test_replies_that_cannot_be_written_end_in_status_1);
    RUN_TEST(test_vcd_file_is_written_and_its_failure_is_status_1);
    remove_folder();
    return UNITY_END();
}
