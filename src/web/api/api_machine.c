/* API: the machine, as `cuvette machine` describes it. */
#include "web/api/api.h"

#include "report/machine.h"

status api_machine(call *c)
{
    machine_report account = {0};
    const status code = machine_measure(&account, &c->why);
    if (code == STATUS_OK)
        api_reply_json(c, machine_json(&account));
    machine_release(&account);
    return code;
}
