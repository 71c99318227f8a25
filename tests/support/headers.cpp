// Nothing but what is precompiled: tests/CMakeLists.txt says which headers.
