# Sweeps by engines of others: dask, GNU parallel, Slurm. Each test is always there, and is skipped, and says why, where its
# engine is missing: scripts/setup.sh --sweep --slurm.
if(NOT TARGET ist_cli OR NOT TARGET ist_shared OR IST_SANITIZERS)
  return()
endif()

function(ist_add_engine_test name script)
  ist_add_command(Sweep.${name} slow /usr/bin/python3 -B ${CMAKE_CURRENT_SOURCE_DIR}/${script})
  set_tests_properties(Sweep.${name} PROPERTIES ENVIRONMENT
                       "IST_LIBRARY=$<TARGET_FILE:ist_shared>;IST_COMMAND=$<TARGET_FILE:ist_cli>;PYTHONPATH=${PROJECT_SOURCE_DIR}/src/python")
endfunction()

ist_add_engine_test(Dask dask_test.py)
ist_add_engine_test(Parallel parallel_test.py)
ist_add_engine_test(SlurmByHand slurm_by_hand_test.py)
ist_add_engine_test(Memory memory_test.py)
ist_add_engine_test(Slurm slurm_test.py)
set_tests_properties(Sweep.Slurm PROPERTIES LABELS long)
