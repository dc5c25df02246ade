// How techniques read the empty intervals of a ray group.

// Two t between which no ray of this group touches anything: interval 0, the next one … Where there is none, it begins beyond every end.
real2 empty_interval(int number)
{
    return number < intervals_count ? load_intervals(ray_group() * intervals_count + number) : real2(2);
}
