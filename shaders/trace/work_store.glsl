// Before and after a ray, where work is counted (work_store.count_work.glsl).
void begin_work() {}
void store_work(uint index, TraceResult result, bool answers, int own_lane) {}
