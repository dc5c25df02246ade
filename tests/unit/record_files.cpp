// results.csv under attack: odd text, full disks, kills at any moment, two writers.
#include "core/error.h"
#include "core/files.h"
#include "errors.h"
#include "harness/passes.h"
#include "harness/result_folder.h"
#include "harness/samples.h"
#include "harness/source_rows.h"
#include "temp_folder.h"

#include <csignal>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using enum ColumnType;

const std::vector<Column> columns = {{"run_id", "", words}, {"value", "", words}, {"message", "", words}};
const Environment         here    = {{{"specification", "a"}, {"shaders", "b"}}, {{"commit", "\xff not UTF-8"}}, ""};

struct RecordFiles : testing::Test {
    TempFolder temp;
    fs::path   folder = temp / "results, \"ü\" 1";

    std::vector<CsvRecord> rows() const
    {
        const std::string      text = read_file(folder / "results.csv");
        std::string_view       rest = text;
        std::vector<CsvRecord> records;
        while (auto record = take_csv_record(rest)) records.push_back(*record);
        EXPECT_TRUE(rest.empty()) << "torn tail";
        EXPECT_EQ(records.at(0), names_of(columns));
        records.erase(records.begin());
        return records;
    }
};

Record row_of(int i)
{
    return {{"run_id", "r" + std::to_string(i)},
            {"value", std::string(200, 'x')},
            {"message", "a\n\"b\",ü" + std::to_string(i)}};
}

/// A line of sources.csv.
std::string source_line(const std::string& id)
{
    CsvRecord fields(source_file_columns().size(), "1");
    fields.front() = id;
    return csv_line(fields);
}

TEST_F(RecordFiles, OddTextComesBackAsItWas)
{
    const std::vector<std::string> texts = {
        "", "plain", "a,b", "\"", "\"\"", "line\nbreak", "crlf\r\n", "Überschrift – 反射", " blank ", ",", "'"};
    {
        ResultFolder results(folder, columns, here, false);
        for (size_t i = 0; i < texts.size(); ++i)
            results.append({{"run_id", "r" + std::to_string(i)}, {"message", texts[i]}});
    }
    const auto records = rows();
    ASSERT_EQ(records.size(), texts.size());
    for (size_t i = 0; i < texts.size(); ++i) EXPECT_EQ(records[i], (CsvRecord{"r" + std::to_string(i), "", texts[i]}));
    EXPECT_THAT(csv_line({"a", "b,c"}), testing::StrEq("a,\"b,c\"\r\n"));
}

TEST_F(RecordFiles, NothingIsOverwritten)
{
    {
        ResultFolder(folder, columns, here, false).append(row_of(1));
    }
    const std::string before = read_file(folder / "results.csv");
    EXPECT_THAT(message_of<SpecError>([&] { ResultFolder(folder, columns, here, false); }),
                HasSubstr("results.csv: already there; continue it with --resume"));
    EXPECT_EQ(read_file(folder / "results.csv"), before);
}

TEST_F(RecordFiles, ResumeRefusesWhatChangedAndNamesIt)
{
    {
        ResultFolder(folder, columns, here, false).append(row_of(1));
    }
    Environment other         = here;
    other.identity["shaders"] = "c";
    other.identity["scene s"] = "d";
    EXPECT_THAT(message_of<SpecError>([&] { ResultFolder(folder, columns, other, true); }),
                HasSubstr("these changed: shaders, scene s"));
    EXPECT_THAT(message_of<SpecError>([&] {
                    ResultFolder(folder, {{"run_id", "", words}, {"else", "", words}}, here, true);
                }),
                HasSubstr("its columns are not those"));
    EXPECT_TRUE(ResultFolder(folder, columns, here, true).finished().contains("r1"));
}

TEST_F(RecordFiles, ASecondWriterIsRefusedWhileTheFirstLives)
{
    auto first = std::make_unique<ResultFolder>(folder, columns, here, false);
    EXPECT_THAT(message_of<Failure>([&] { ResultFolder(folder, columns, here, true); }),
                HasSubstr("process " + std::to_string(::getpid())));
    first.reset();
    EXPECT_NO_THROW(ResultFolder(folder, columns, here, true));
}

TEST_F(RecordFiles, AWriterThatHasLostItsParentIsWaitedFor)
{
    const auto is_orphan = [] { return ::getppid() == 1; };
    // The child ends at once; its own child keeps the folder for four seconds.
    if (::fork() == 0) {
        if (::fork() == 0) {
            for (int i = 0; i < 5000 && !is_orphan(); ++i) ::usleep(1000);
            if (!is_orphan()) ::_exit(1);
            ResultFolder results(folder, columns, here, false);
            results.append(row_of(1));
            ::sleep(4);
            ::_exit(0);
        }
        ::_exit(0);
    }
    ::wait(nullptr);
    for (int i = 0; i < 1000 && !fs::exists(folder / "results.csv"); ++i) ::usleep(10'000);
    if (!fs::exists(folder / "results.csv")) GTEST_SKIP() << "here orphans are not the first process's";
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(ResultFolder(folder, columns, here, true).finished().contains("r1"));
    EXPECT_GT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST_F(RecordFiles, ATornTailIsCutAtEveryByte)
{
    {
        ResultFolder results(folder, columns, here, false);
        results.append(row_of(1));
        results.append(row_of(2));
    }
    const std::string whole = read_file(folder / "results.csv");
    const size_t      last  = whole.find("r2,");
    for (size_t length = last; length < whole.size(); ++length) {
        write_file_atomically(folder / "results.csv", whole.substr(0, length));
        ResultFolder results(folder, columns, here, true);
        ASSERT_EQ(results.finished().size(), 1U);
        results.append(row_of(2));
        ASSERT_EQ(read_file(folder / "results.csv"), whole) << "torn at " << length;
    }
}

TEST_F(RecordFiles, DamageIsReportedNotRepaired)
{
    {
        ResultFolder results(folder, columns, here, false);
        results.append(row_of(1));
        results.append(row_of(2));
    }
    const std::string whole = read_file(folder / "results.csv");
    write_file_atomically(folder / "results.csv", whole + "r1,x,y\r\n");
    EXPECT_THAT(message_of<Failure>([&] { ResultFolder(folder, columns, here, true); }),
                HasSubstr("'r1' is there twice"));
    write_file_atomically(folder / "results.csv", whole + "r3,x\r\n");
    EXPECT_THAT(message_of<Failure>([&] { ResultFolder(folder, columns, here, true); }),
                HasSubstr("wrong number of fields"));
    EXPECT_EQ(read_file(folder / "results.csv"), whole + "r3,x\r\n");
}

TEST_F(RecordFiles, FailedRowsAreTriedAgainOnceAndInNoWayDoubled)
{
    const std::vector<Column> with_outcome = {{"run_id", "", words}, {"outcome", "", words}, {"message", "", words}};
    const auto                append       = [&](ResultFolder& results, const char* id, const char* outcome) {
        results.append({{"run_id", id}, {"outcome", outcome}, {"message", "a\n\"b\""}});
    };
    {
        ResultFolder results(folder, with_outcome, here, false);
        append(results, "r1", "ok");
        append(results, "r2", "failed");
        append(results, "r3", "no_rays");
        EXPECT_EQ(results.finished().size(), 3U);
    }
    {
        ResultFolder results(folder, with_outcome, here, true);
        EXPECT_EQ(results.finished(), (std::set<std::string>{"r1", "r3"}));
        append(results, "r2", "ok");
    }
    const std::string whole = read_file(folder / "results.csv");
    EXPECT_EQ(whole, csv_line(names_of(with_outcome)) + csv_line({"r1", "ok", "a\n\"b\""}) +
                         csv_line({"r3", "no_rays", "a\n\"b\""}) + csv_line({"r2", "ok", "a\n\"b\""}));
    EXPECT_EQ(ResultFolder(folder, with_outcome, here, true).finished().size(), 3U);
    EXPECT_EQ(read_file(folder / "results.csv"), whole);
}

// r1 has all of its samples, passes and sources, r2 one of two samples, r3 is invalid, r4 lacks a pass, r5 a source.
TEST_F(RecordFiles, RowsWithoutAllOfTheirOtherLinesAreMeasuredAnew)
{
    const std::vector<Column> with_repeats = {{"run_id", "", words},
                                              {"outcome", "", words},
                                              {"repeats", "", whole},
                                              {"passes_ran", "", whole},
                                              {"sources_asked", "", whole}};
    const auto                row          = [](const char* id, int repeats) {
        return Record{{"run_id", id}, {"outcome", "ok"}, {"repeats", repeats}, {"passes_ran", 2}, {"sources_asked", 2}};
    };
    const auto sources = [](const char* id) { return source_line(id) + source_line(id); };
    const auto passes  = [](const std::string& id) {
        return id + ",rays,true,1,,,8,9,a\r\n" + id + ",blur,false,,,,,,\"b, c\"\r\n" + id +
               ",trace,true,2,1,3,8,9,d\r\n";
    };
    const auto sample = [](const char* id, int round) {
        return csv_line({id, std::to_string(round), "trace", "1", ""}) +
               csv_line({id, std::to_string(round), "frame", "2", "3"});
    };
    {
        ResultFolder results(folder, with_repeats, here, false);
        results.append(row("r1", 2), {sample("r1", 0) + sample("r1", 4), passes("r1"), sources("r1")});
        results.append(row("r2", 2), {sample("r2", 3), passes("r2"), sources("r2")});
        results.append({{"run_id", "r3"}, {"outcome", "invalid"}});
        results.append(row("r4", 1), {sample("r4", 3), "r4,trace,true,2,1,3,8,9,d\r\n", sources("r4")});
        results.append(row("r5", 1), {sample("r5", 3), passes("r5"), source_line("r5")});
    }
    const ResultFolder resumed(folder, with_repeats, here, true);
    EXPECT_EQ(resumed.finished(), std::set<std::string>{"r1"});
    EXPECT_EQ(resumed.next_round(), 5);
    EXPECT_EQ(read_file(folder / "samples.csv"), csv_line(sample_columns()) + sample("r1", 0) + sample("r1", 4));
    EXPECT_EQ(read_file(folder / "passes.csv"), csv_line(names_of(pass_columns())) + passes("r1"));
    EXPECT_EQ(read_file(folder / "sources.csv"), csv_line(names_of(source_file_columns())) + sources("r1"));
    EXPECT_EQ(read_file(folder / "results.csv"),
              csv_line(names_of(with_repeats)) + csv_line({"r1", "ok", "2", "2", "2"}));
}

TEST_F(RecordFiles, AFolderOfTheOldFormIsRefusedWithTheWayOut)
{
    ResultFolder(folder, columns, here, false).append(row_of(1));
    const std::string passes = read_file(folder / "passes.csv");
    write_file_atomically(folder / "passes.csv", "run_id,pass,ran,ms_median,ms_ci_low,ms_ci_high,reason\r\n");
    EXPECT_THAT(message_of<SpecError>([&] { ResultFolder(folder, columns, here, true); }),
                HasSubstr("without bytes_read_mean; measure it anew: ssrlab run"));
    write_file_atomically(folder / "passes.csv", passes);
    write_file_atomically(folder / "results.csv", "run_id,passes,passes_why\r\nr1,trace=1,trace: a\r\n");
    EXPECT_THAT(message_of<SpecError>([&] { ResultFolder(folder, columns, here, true); }),
                HasSubstr("without passes.csv; measure it anew: ssrlab run"));
    write_file_atomically(folder / "results.csv", "run_id,passes_ran\r\nr1,1\r\n");
    fs::remove(folder / "sources.csv");
    EXPECT_THAT(message_of<SpecError>([&] { ResultFolder(folder, columns, here, true); }),
                HasSubstr("without sources.csv; measure it anew: ssrlab run"));
}

TEST_F(RecordFiles, ValuesComeBackByTheTypeOfTheirColumn)
{
    const Column    typed[] = {{"m", ""}, {"w", "", whole}, {"s", "", setting}, {"c", "", setting}, {"t", "", words}};
    const Record    record  = {{"m", 1.0 / 3}, {"w", 2073600}, {"s", 0.123456789}, {"c", "view"}, {"t", "12"}};
    const CsvRecord fields  = {"0.333333", "2073600", "0.123456789", "view", "12"};
    Record          back    = record;
    back["m"]               = 0.333333;
    EXPECT_EQ(fields_of(record, typed), fields);
    EXPECT_EQ(record_of(fields, typed), back);
    EXPECT_EQ(record_of({"", "", "inf", "", ""}, typed), (Record{{"s", std::numeric_limits<double>::infinity()}}));
    EXPECT_EQ(number_of(record, "w"), 2073600);
    EXPECT_EQ(number_of(record, "t"), std::nullopt) << "words";
    EXPECT_EQ(words_of(record, "m"), "") << "a number";
    Record empty;
    put(empty, "m", std::nan(""));
    EXPECT_TRUE(empty.empty());
}

TEST_F(RecordFiles, DifferencesAreNamedFromBothSides)
{
    EXPECT_THAT(differences({{"a", "1"}, {"b", "2"}, {"c", "3"}}, {{"b", "2"}, {"c", "4"}, {"d", "5"}}),
                testing::UnorderedElementsAre("a", "c", "d"));
}

TEST_F(RecordFiles, UnknownColumnsAreRefused)
{
    ResultFolder results(folder, columns, here, false);
    EXPECT_THAT(message_of<Failure>([&] {
                    results.append({{"run_id", "r"}, {"valeu", "1"}});
                }),
                HasSubstr("has no column 'valeu'"));
}

/// Runs `child` in a process of its own; returns its wait status.
template <typename Child> int in_child(const Child& child, useconds_t kill_after_us = 0)
{
    const pid_t pid = ::fork();
    if (pid == 0) {
        try {
            child();
        } catch (...) {
            ::_exit(99);
        }
        ::_exit(0);
    }
    if (kill_after_us > 0) {
        ::usleep(kill_after_us);
        ::kill(pid, SIGKILL);
    }
    int status = 0;
    ::waitpid(pid, &status, 0);
    return status;
}

TEST_F(RecordFiles, KillsLoseDoubleOrTearNoRow)
{
    constexpr int row_count = 120;
    std::mt19937  random(3);
    int           kills = 0, sweeps = 0;
    while (kills < 200) {
        fs::remove_all(folder);
        for (bool complete = false; !complete;) {
            const auto sweep = [&] {
                ResultFolder results(folder, columns, here, true);
                for (int i = 0; i < row_count; ++i) {
                    const std::string id = "r" + std::to_string(i);
                    if (!results.finished().contains(id))
                        results.append(row_of(i), {.samples = id + ",0,frame,1,1\r\n",
                                                   .passes  = id + ",trace,true,1,,,,,\r\n",
                                                   .sources = source_line(id)});
                }
            };
            const int status = in_child(sweep, useconds_t(500 + random() % 20000));
            ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
            kills += WIFSIGNALED(status) ? 1 : 0;
            complete = !WIFSIGNALED(status);
        }
        ++sweeps;
        const auto records = rows();
        ASSERT_EQ(records.size(), static_cast<size_t>(row_count));
        const SampleCounts samples = count_samples(read_file(folder / "samples.csv"));
        ASSERT_EQ(samples.frames.size(), static_cast<size_t>(row_count));
        for (const auto& [id, frames] : samples.frames) ASSERT_EQ(frames, 1) << id;
        const auto passes = count_passes(read_file(folder / "passes.csv"));
        ASSERT_EQ(passes.size(), static_cast<size_t>(row_count));
        for (const auto& [id, ran] : passes) ASSERT_EQ(ran, 1) << id;
        const auto sources = count_sources(read_file(folder / "sources.csv"));
        ASSERT_EQ(sources.size(), static_cast<size_t>(row_count) + 1) << "with the header";
        for (const auto& [id, asked] : sources) ASSERT_EQ(asked, 1) << id;
        for (int i = 0; i < row_count; ++i) {
            ASSERT_EQ(records[static_cast<size_t>(i)], fields_of(row_of(i), columns));
        }
        for (const auto& entry : fs::directory_iterator(folder))
            EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos);
    }
    RecordProperty("kills", kills);
    RecordProperty("sweeps", sweeps);
}

TEST_F(RecordFiles, AFullDiskLeavesACorrectPrefixAndCanBeContinued)
{
    {
        ResultFolder(folder, columns, here, false).append(row_of(0));
    }
    const auto one_row = fs::file_size(folder / "results.csv");
    for (rlim_t limit = one_row; limit < one_row + 700; limit += 13) {
        const int status = in_child([&] {
            ::signal(SIGXFSZ, SIG_IGN);
            ResultFolder results(folder, columns, here, true);
            const rlimit small = {limit, limit};
            ::setrlimit(RLIMIT_FSIZE, &small);
            const std::string message = message_of<Failure>([&] {
                for (int i = 1; i < 9; ++i)
                    if (!results.finished().contains("r" + std::to_string(i))) results.append(row_of(i));
            });
            if (message.find("results.csv: writing the row of run r") == std::string::npos) ::_exit(1);
            if (message.find("the rows before it are intact") == std::string::npos) ::_exit(2);
        });
        ASSERT_EQ(status, 0);
        const auto records = rows();
        for (size_t i = 0; i < records.size(); ++i) EXPECT_EQ(records[i][0], "r" + std::to_string(i));
    }
    ResultFolder results(folder, columns, here, true);
    EXPECT_EQ(results.finished().size(), 4U);
}

TEST_F(RecordFiles, UnwritableFoldersAreNamed)
{
    EXPECT_THAT(message_of<Failure>([&] { ResultFolder("/proc/nothing/here", columns, here, false); }),
                HasSubstr("/proc/nothing/here: cannot be created"));
    fs::create_directories(folder.parent_path());
    write_file_atomically(folder, "a file");
    EXPECT_THROW(ResultFolder(folder, columns, here, false), Failure);
    EXPECT_EQ(read_file(folder), "a file");
}

TEST_F(RecordFiles, AtomicFilesAreWholeOrAbsent)
{
    EXPECT_THAT(message_of<Failure>([&] { write_file_atomically("/dev/full/x", "y"); }), HasSubstr("/dev/full/x"));
    const int fd = ::open("/dev/full", O_WRONLY);
    EXPECT_FALSE(write_fully(fd, "y"));
    ::close(fd);
    fs::create_directories(folder);
    write_file_atomically(folder / "a.txt", "old");
    const int status = in_child([&] {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit small = {10, 10};
        ::setrlimit(RLIMIT_FSIZE, &small);
        if (message_of<Failure>([&] {
                write_file_atomically(folder / "a.txt", std::string(100, 'n'));
            }).find("a.txt: writing failed") == std::string::npos)
            ::_exit(1);
    });
    EXPECT_EQ(status, 0);
    EXPECT_EQ(read_file(folder / "a.txt"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

} // namespace
} // namespace ssrlab
