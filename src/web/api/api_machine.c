#include "web/api/api_machine.h"
#include "report/machine.h"

void api_machine(void *context, const http_request *q, http_reply *r)
{
    (void)context, (void)q;
    machine_account account = {0};
    diagnostic why = {.what = ""};
    const status code = machine_look(&account, &why);
    if (code == STATUS_OK)
        http_reply_json(r, 200, machine_json(&account));
    else
        http_reply_diagnostic(r, code, &why);
    machine_release(&account);
}
