/* SPDX-License-Identifier: Apache-2.0 */
/* Keys: what the row shows and which command comes out. */
#include "terminal.h"
#include "unity.h"
#include <string.h>

static terminal t;

#define UP "\033[A"
#define DOWN "\033[B"
#define RIGHT "\033[C"
#define LEFT "\033[D"

void setUp(void)
{
    terminal_init(&t);
}

void tearDown(void)
{
}

static void shows(const char *row, int column)
{
    TEST_ASSERT_EQUAL_STRING(row, t.row);
    TEST_ASSERT_EQUAL(column, t.column);
}

static void test_greeting_and_prompt(void)
{
    terminal_restart(&t, true);
    terminal_settle(&t);
    TEST_ASSERT_EQUAL_STRING("\r\nbqhost " PROJECT_VERSION " fake-board\r\n> ", t.text);
    TEST_ASSERT_TRUE(bq_console_idle(&t.console));
}

static void test_letters_echo(void)
{
    terminal_type(&t, "stat");
    shows("> stat", 6);
    TEST_ASSERT_EQUAL_STRING("stat", t.text);
}

static void test_every_end_of_line_ends_one_line(void)
{
    static const char *const ends[] = {"\r", "\n", "\r\n"};

    for (int i = 0; i < 3; i++) {
        terminal_forget(&t);
        terminal_type(&t, "nonsense");
        terminal_type(&t, ends[i]);
        TEST_ASSERT_EQUAL_STRING("nonsense\r\nunknown, try help\r\n> ", t.text);
    }
    terminal_forget(&t);
    terminal_type(&t, "\r\r\n\n");
    TEST_ASSERT_EQUAL_STRING("\r\n> \r\n> \r\n> ", t.text);
}

static void test_backspace_and_delete(void)
{
    terminal_type(&t, "statux\b");
    shows("> statu", 7);
    terminal_type(&t, "s\177\177");
    shows("> stat", 6);
    terminal_type(&t, LEFT LEFT "\b");
    shows("> sat", 3);
    terminal_type(&t, "\033[3~");
    shows("> st", 3);
    terminal_type(&t, "\004\005\004\b"); /* Ctrl-D at the end: nothing */
    shows("> ", 2);
    terminal_type(&t, "\b\b");
    shows("> ", 2);
}

static void test_the_cursor_moves_and_characters_go_in_between(void)
{
    terminal_type(&t, "sttus" LEFT LEFT LEFT "a");
    shows("> status", 5);
    terminal_type(&t, "\033[H!");
    shows("> !status", 3);
    terminal_type(&t, "\033[F?");
    shows("> !status?", 10);
    terminal_type(&t, "\001\004\005\b");
    shows("> status", 8);
    terminal_type(&t, "\033OH" LEFT LEFT RIGHT);
    shows("> status", 3);
    terminal_type(&t, "\033[4~" RIGHT);
    shows("> status", 8);
    terminal_type(&t, "\033[1~");
    shows("> status", 2);
    terminal_type(&t, "\002\006\006\006");
    shows("> status", 5);
}

static void test_kill_abandon_and_redraw(void)
{
    terminal_type(&t, "nonsense\025");
    shows("> ", 2);
    terminal_type(&t, "non\003");
    shows("> ", 2);
    TEST_ASSERT_NOT_NULL(strstr(t.text, "non^C\r\n> "));
    terminal_type(&t, "abc");
    memset(t.row, 0, sizeof t.row); /* something else wrote over it */
    t.column = 0;
    terminal_type(&t, "\014");
    shows("> abc", 5);
}

static void test_a_full_line_rings_and_keeps_its_text(void)
{
    char line[BQ_CONSOLE_LINE + 1u];

    memset(line, 'x', BQ_CONSOLE_LINE);
    line[BQ_CONSOLE_LINE] = '\0';
    terminal_type(&t, line);
    TEST_ASSERT_EQUAL(0, t.bells);
    terminal_type(&t, "y\033[Hz");
    TEST_ASSERT_EQUAL(2, t.bells);
    TEST_ASSERT_EQUAL_STRING(line, t.row + 2);
    terminal_type(&t, "\033[3~\033[3~a");
    TEST_ASSERT_EQUAL('a', t.row[2]);
    terminal_type(&t, "\r");
    TEST_ASSERT_NOT_NULL(strstr(t.text, "unknown"));
}

static void test_what_is_no_key_is_ignored(void)
{
    for (int byte = 1; byte < 256; byte++) {
        const char key[2] = {(char)byte, '\0'};
        if ((byte < ' ' || byte > 127) &&
            strchr("\001\002\003\004\005\006\b\n\014\r\016\020\025\033", byte) == NULL) {
            terminal_type(&t, key);
            shows("> ", 2);
        }
    }
    terminal_type(&t, "\033[5~\033[Z\033OP\033x\033[15~a");
    shows("> a", 3);
    terminal_type(&t, "\033\r"); /* half a sequence does not swallow the end of the line */
    TEST_ASSERT_NOT_NULL(strstr(t.text, "unknown"));
}

/* ---- history ---- */

static void test_history_goes_up_and_down_and_keeps_the_line_begun(void)
{
    (void)terminal_ask(&t, "one");
    (void)terminal_ask(&t, "two");
    (void)terminal_ask(&t, "three");
    terminal_type(&t, "begun" UP);
    shows("> three", 7);
    terminal_type(&t, UP UP);
    shows("> one", 5);
    terminal_forget(&t);
    terminal_type(&t, UP); /* nothing older */
    TEST_ASSERT_EQUAL(1, t.bells);
    shows("> one", 5);
    terminal_type(&t, DOWN);
    shows("> two", 5);
    terminal_type(&t, "\016\016");
    shows("> begun", 7);
    terminal_forget(&t);
    terminal_type(&t, DOWN);
    TEST_ASSERT_EQUAL(1, t.bells);
    shows("> begun", 7);
}

static void test_history_holds_the_last_different_lines(void)
{
    static const char *const lines[] = {"a", "b", "b", "c", "", "d", "e", "f"};

    for (int i = 0; i < 8; i++) {
        (void)terminal_ask(&t, lines[i]);
    }
    terminal_type(&t, UP);
    shows("> f", 3);
    terminal_type(&t, "\020\020\020\020");
    shows("> b", 3);
    terminal_forget(&t);
    terminal_type(&t, UP);
    TEST_ASSERT_EQUAL(1, t.bells);
}

static void test_a_recalled_line_can_be_changed_and_run(void)
{
    (void)terminal_ask(&t, "xersion");
    terminal_forget(&t);
    terminal_type(&t, UP "\001\004v\r");
    TEST_ASSERT_NOT_NULL(strstr(t.text, "bqhost "));
    terminal_type(&t, UP);
    shows("> version", 9);
    terminal_type(&t, UP);
    shows("> xersion", 9);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_greeting_and_prompt);
    RUN_TEST(test_letters_echo);
    RUN_TEST(test_every_end_of_line_ends_one_line);
    RUN_TEST(test_backspace_and_delete);
    RUN_TEST(test_the_cursor_moves_and_characters_go_in_between);
    RUN_TEST(test_kill_abandon_and_redraw);
    RUN_TEST(test_a_full_line_rings_and_keeps_its_text);
    RUN_TEST(test_what_is_no_key_is_ignored);
    RUN_TEST(test_history_goes_up_and_down_and_keeps_the_line_begun);
    RUN_TEST(test_history_holds_the_last_different_lines);
    RUN_TEST(test_a_recalled_line_can_be_changed_and_run);
    return UNITY_END();
}
