# roio_add_contract_test(<name> <source>...): the contract of roio::Bus as a test program, against the
# buses that the sources name: they define roio::test::backends() (tests/host/contract/backends.hpp).
# For backends outside of this tree, too: docs/backend.md. It needs GoogleTest.
include_guard(GLOBAL)
set(roio_contract_dir ${CMAKE_CURRENT_LIST_DIR}/../tests/host/contract)

function(roio_add_contract_test name)
  find_package(GTest REQUIRED)
  find_package(Threads REQUIRED)
  include(GoogleTest)
  # The suite is compiled once, whoever takes it.
  if(NOT TARGET roio_contract)
    set(parts contract event_test filter_test flow_test frame_test node_test order_test wait_test)
    list(TRANSFORM parts PREPEND ${roio_contract_dir}/)
    list(TRANSFORM parts APPEND .cpp)
    add_library(roio_contract OBJECT ${parts})
    target_include_directories(roio_contract PUBLIC ${roio_contract_dir})
    target_link_libraries(roio_contract
      PUBLIC roio::roio GTest::gtest_main Threads::Threads
      PRIVATE $<TARGET_NAME_IF_EXISTS:roio_warnings>)
  endif()
  add_executable(${name} ${ARGN} $<TARGET_OBJECTS:roio_contract>)
  target_include_directories(${name} PRIVATE ${roio_contract_dir})
  target_link_libraries(${name}
    PRIVATE roio::roio GTest::gtest_main Threads::Threads $<TARGET_NAME_IF_EXISTS:roio_warnings>)
  string(REGEX REPLACE "_test$" "" prefix ${name})
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST TEST_PREFIX ${prefix}. PROPERTIES TIMEOUT 120)
endfunction()
